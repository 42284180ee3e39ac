"""The engine "bullet": PyBullet moves the bodies, slipgym computes friction and sensing between its steps."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import Any, NoReturn

import numpy as np

from slipgym.config import Config
from slipgym.world import bullet_tilt, bullet_upright, scene
from slipgym.world.bullet_client import Client
from slipgym.world.bullet_rows import BulletRows, read_engine
from slipgym.world.placing import place
from slipgym.world.plant import Plant
from slipgym.world.quiet_pybullet import p
from slipgym.world.scene import FINGER_LINKS, JOINTS, WRIST_JOINTS, Box
from slipgym.world.snapshot import EngineState, load_engine, save_engine
from slipgym.world.tilt_placing import place_tilt
from slipgym.world.wrist import ramp_wrist


class BulletWorld:
    """One gripper and one box in a physics client of their own.

    The scene is built once; an episode starts from a saved state of it, in which the pads
    touch the box. Only another geometry builds another box. An exception during a call leaves a world without
    a box, for which the next reset builds everything again.

    Args:
        config: Configuration; gripper, physics and the rates are read.
        plant: Arrays of one world, which sensors and controllers use as well.
    """

    def __init__(self, config: Config, plant: Plant) -> None:
        self._config = config
        self._plant = plant
        self._client = Client()
        self._box: Box | None = None
        self._gripper = self._body = self._saved = -1
        self._mass_set: tuple[float, float] | None = None
        self._reading: tuple[Any, ...] = ()

    @property
    def client(self) -> int:
        """PyBullet's id of the physics client.

        Raises:
            RuntimeError: The world is closed.
        """
        return self._client.number

    @property
    def closed(self) -> bool:
        """Whether the world was closed."""
        return self._client.closed

    @property
    def box(self) -> Box:
        """The box of this episode.

        Raises:
            RuntimeError: There was no reset yet, or the last call was interrupted.
        """
        if self._box is None:
            raise RuntimeError("call reset() first: there is no object yet")
        return self._box

    @property
    def body(self) -> int:
        """PyBullet's id of the box."""
        return self._body

    @property
    def gripper(self) -> int:
        """PyBullet's id of the gripper."""
        return self._gripper

    @property
    def reading(self) -> tuple[Any, ...]:
        """Readings of the engine after its last step.

        Pose and velocity of the box, positions of the wrist's joints, normal forces, speeds of all joints.
        """
        return self._reading

    def reset(
        self,
        box: Box,
        force: float,
        wrist: tuple[float, float, float] = (0.0, 0.0, 0.0),
        roll: float = 0.0,
    ) -> None:
        """Start an episode: the box held still by both fingers.

        Args:
            box: The object.
            force: Grip force per finger, already established [N].
            wrist: Pad centre (x, z) and pitch [m, m, rad].
            roll: Of the wrist, with `physics.tilt` [rad].
        """
        client = self._rebuilt(box)
        p.restoreState(stateId=self._saved, physicsClientId=client)
        place(self._plant, 0, box, force, wrist)
        if self._plant.tilt is not None:
            place_tilt(self._plant, 0, box, force, roll)
        if any(wrist) or self._plant.tilt is not None:
            self._place(wrist)
        *bodies, speeds = self._read(client, self._body, self._gripper)
        self._reading = *bodies, tuple(self._plant.fingers["contact_force"][0].tolist()), speeds
        self._box = box

    def command(self, force: float) -> None:
        """Command a grip force per finger [N]; both fingers get the same."""
        self.rows.queue(force)

    def command_wrist(self, velocity: np.ndarray, duration: float) -> None:
        """Ramp the wrist velocity to a target within `duration`.

        Args:
            velocity: Along x, along z and in pitch, (3,) [m/s, m/s, rad/s]; brought down to the
                gripper's `wrist_speed_max`, direction kept, and `wrist_pitch_rate_max`.
            duration: Length of the ramp [s].
        """
        gripper = self._config.gripper
        limits = gripper.wrist_speed_max, gripper.wrist_pitch_rate_max
        x, z, pitch = velocity
        ramp_wrist(self._plant.world[0], x, z, pitch, *limits, duration)

    def update_mass(self, mass: float) -> None:
        """Set mass and inertia of the engine's box to those of the planar world, if the mass has changed.

        Args:
            mass: That of the planar world [kg].
        """
        box = self.box
        if mass != box.mass:
            self._box = None
            box = replace(box, mass=mass, inertia=self._plant.world["inertia"].item())
            self._set_mass(mass, box.inertia)
            self._place_links(self.client)
            self._box = box

    def disturb(self, wrench: np.ndarray) -> None:
        """Apply a load (f_x, f_z, torque) to the object's centre of mass until the next call."""
        self._plant.world["external"] = wrench

    def step(self) -> None:
        """Advance by one control step."""
        pose, _, wrist, normals, _ = self.move()
        read_engine(self._plant.world, self._plant.fingers, pose, wrist, normals)

    def move(self, mass: float | None = None) -> tuple[Any, ...]:
        """Advance the bodies by one control step; the planar world has yet to take over the `reading`.

        Args:
            mass: As for `update_mass`, which is called first if it has changed; None: unchanged [kg].

        Returns:
            `reading`.

        Raises:
            RuntimeError: The world is closed, needs a reset, or its physics client is gone.
        """
        client = self._client.checked()
        if mass is not None and mass != (self._box or self.box).mass:
            self.update_mass(mass)
        box, self._box = self._box or self.box, None
        reading = self._reading = self._advance(self._reading)
        self._place_links(client)
        self._box = box
        return reading

    @cached_property
    def _advance(self) -> Callable[[tuple[Any, ...]], tuple[Any, ...]]:
        """Advances the bodies by the engine steps of a control step, for a reading; new for other bodies."""
        physics = self._config.physics
        given = self._client.number, self._body, self._gripper, self.rows, physics.engine_steps
        if self._plant.tilt is None:
            return bullet_upright.stepper(*given, self._config.gripper.finger_mass * physics.engine_rate)
        return bullet_tilt.stepper(*given, self._read)

    @cached_property
    def rows(self) -> BulletRows:
        """The compiled functions of this world."""
        return BulletRows(self._plant)

    def bind(self) -> None:
        """Find the compiled functions anew, after an array of the plant was replaced."""
        self.rows = BulletRows(self._plant)
        self.__dict__.pop("_advance", None)

    def get_state(self) -> EngineState:
        """Everything that the engine's next step depends on, except the plant's arrays.

        Raises:
            RuntimeError: The world is closed, or there was no reset yet.
        """
        client, box = self._client.checked(), self.box
        return EngineState(save_engine(client), box, self._reading)

    def set_state(self, state: EngineState) -> None:
        """Restore a state, also one of another world or process; the plant's arrays are not changed.

        Raises:
            RuntimeError: The world is closed.
        """
        client = self._rebuilt(state.box)
        load_engine(client, state.engine)
        self._reading = state.reading
        self._place_links(client)
        self._box = state.box

    def discard(self) -> None:
        """Drop the bodies: the next reset builds them again."""
        self._box = None

    def close(self) -> None:
        """Disconnect the client; the world cannot be used again. Closing twice is harmless."""
        self._client.close()

    def __del__(self) -> None:
        if getattr(self, "_client", None) is not None and p is not None:
            self.close()

    def __reduce__(self) -> NoReturn:
        raise TypeError(
            "a BulletWorld cannot be copied or pickled: two copies would share one physics client; "
            "save get_state()"
        )

    def _rebuilt(self, box: Box) -> int:
        """Bring this box into the world, which has none until the caller has finished.

        Returns:
            PyBullet's id of the physics client.
        """
        client, built = self._client.checked(), self._box
        self._box = None
        if built is None or _geometry(box) != _geometry(built):
            self._build(box)
        self._set_mass(box.mass, box.inertia)
        return client

    def _set_mass(self, mass: float, inertia: float) -> None:
        if (mass, inertia) != self._mass_set:
            scene.set_mass(self.client, self._body, mass, inertia, self._plant.tilt is not None)
            self._mass_set = mass, inertia

    @staticmethod
    def _read(client: int, body: int, gripper: int) -> tuple[Any, ...]:
        """Pose and velocity of the box, positions of the wrist's joints, speeds of all."""
        pose = p.getBasePositionAndOrientation(body, client)
        velocity = p.getBaseVelocity(body, client)
        x, z, pitch, first, second = p.getJointStates(gripper, JOINTS, client)
        return pose, velocity, (x[0], z[0], pitch[0]), (x[1], z[1], pitch[1], first[1], second[1])

    def _place_links(self, client: int) -> None:
        """Make the engine compute the poses of the gripper's links from its joints.

        A step and a restore round these poses differently. Computed by the same function after both, a
        restored world continues bit for bit. Setting any joint to its own value is enough.
        """
        _, _, positions, _, speeds = self._reading
        p.resetJointState(self._gripper, WRIST_JOINTS[0], positions[0], speeds[0], client)

    def _build(self, box: Box) -> None:
        client = self.client
        self._mass_set = None
        self.__dict__.pop("_advance", None)
        self._client.unmark()
        scene.clear(client, self._config)
        self._gripper = scene.add_gripper(client, self._config, box.size[1])
        self._client.mark(self._gripper)
        self._body = scene.add_box(client, box)
        if self._plant.tilt is None:
            self._saved = scene.settle(client, self._config, self._gripper)
        else:
            self._saved = scene.release(client, self._gripper, self._body)

    def _place(self, wrist: tuple[float, float, float]) -> None:
        client = self.client
        for joint, position in zip(WRIST_JOINTS, wrist, strict=True):
            p.resetJointState(self._gripper, joint, position, 0.0, physicsClientId=client)
        x, z = self._plant.world["com"][0]
        half = -0.5 * wrist[2]
        y, attitude = 0.0, [0.0, math.sin(half), 0.0, math.cos(half)]
        tilt = self._plant.tilt
        if tilt is not None:
            y, attitude = tilt["height"].item(), tilt["attitude"][0]
            for joint in FINGER_LINKS:
                p.resetJointState(self._gripper, joint, tilt["closure"].item(), 0.0, physicsClientId=client)
        p.resetBasePositionAndOrientation(self._body, [x, y, z], attitude, physicsClientId=client)


def _geometry(box: Box) -> tuple[tuple[float, ...], ...]:
    return box.size, box.com_offset, box.grasp_offset
