"""The engine "bullet": PyBullet moves the bodies, slipgym computes friction and sensing between its steps."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import Any, NoReturn

import numpy as np

from slipgym.config import Config
from slipgym.world import scene
from slipgym.world.bullet_client import Client
from slipgym.world.bullet_rows import BulletRows, read_bodies, read_engine, stepper
from slipgym.world.placing import place, place_tilt
from slipgym.world.plant import Plant
from slipgym.world.quiet_pybullet import p
from slipgym.world.scene import FINGER_LINKS, WRIST_JOINTS, Box, EngineState, load_engine, save_engine
from slipgym.world.wrist import ramp_wrist


class DrivenWorld:
    """Drives wrist and object in the planar world of either engine; `plant` has the arrays of one world."""

    def __init__(self, config: Config, plant: Plant) -> None:
        self._config, self._plant = config, plant

    def command_wrist(self, velocity: np.ndarray, duration: float) -> None:
        """Ramp the wrist's velocity (x, z, pitch), (3,), to a target [m/s, m/s, rad/s] within a duration [s].

        The gripper's `wrist_speed_max`, direction kept, and `wrist_pitch_rate_max` limit it.
        """
        gripper = self._config.gripper
        x, z, pitch = velocity
        limits = gripper.wrist_speed_max, gripper.wrist_pitch_rate_max
        ramp_wrist(self._plant.world[0], x, z, pitch, *limits, duration)

    def disturb(self, wrench: np.ndarray) -> None:
        """Apply a load (f_x, f_z, torque) to the object's centre of mass until the next call."""
        self._plant.world["external"] = wrench


class BulletWorld(DrivenWorld):
    """One gripper and one box in a physics client of their own.

    The scene is built once; an episode starts from a saved state of it, in which the pads
    touch the box. Only another geometry builds another box. An exception during a call leaves a world without
    a box, for which the next reset builds everything again.

    Args:
        config: Configuration; gripper, physics and the rates are read.
        plant: Arrays of one world, which sensors and controllers use as well.

    Attributes:
        body: PyBullet's id of the box.
        gripper: PyBullet's id of the gripper.
        reading: Pose and velocity of the box, positions of the wrist's joints, normal forces, and speeds of
            all joints, after the engine's last step.
    """

    def __init__(self, config: Config, plant: Plant) -> None:
        super().__init__(config, plant)
        self._client = Client()
        self._box: Box | None = None
        self.gripper = self.body = self._saved = -1
        self._mass_set: tuple[float, float] | None = None
        self.reading: tuple[Any, ...] = ()

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

    def reset(
        self, box: Box, force: float, wrist: tuple[float, float, float] = (0.0, 0.0, 0.0), roll: float = 0.0
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
        *bodies, speeds = read_bodies(client, self.body, self.gripper)
        self.reading = *bodies, tuple(self._plant.fingers["contact_force"][0].tolist()), speeds
        self._box = box

    def command(self, force: float) -> None:
        """Command a grip force per finger [N]; both fingers get the same."""
        self.rows.queue(force)

    def update_mass(self, mass: float) -> None:
        """Give the engine's box the mass [kg] and inertia of the planar world, if the mass has changed."""
        box = self.box
        if mass != box.mass:
            self._box = None
            box = replace(box, mass=mass, inertia=self._plant.world["inertia"].item())
            self._set_mass(mass, box.inertia)
            self._place_links(self.client)
            self._box = box

    def step(self) -> None:
        """Advance by one control step."""
        pose, _, wrist, normals, _ = self.move()
        read_engine(self._plant.world, self._plant.fingers, pose, wrist, normals)

    def move(self, mass: float | None = None) -> tuple[Any, ...]:
        """Advance the bodies by one control step; the planar world has yet to take over the `reading`.

        A mass is updated first, see `update_mass`.

        Raises:
            RuntimeError: The world is closed, needs a reset, or its physics client is gone.
        """
        client = self._client.checked()
        if mass is not None:
            self.update_mass(mass)
        box, self._box = self.box, None
        reading = self.reading = self._advance(self.reading)
        self._place_links(client)
        self._box = box
        return reading

    @cached_property
    def _advance(self) -> Callable[[tuple[Any, ...]], tuple[Any, ...]]:
        """Advances the bodies by the engine steps of a control step, for a reading; new for other bodies."""
        physics = self._config.physics
        inertia = (
            None if self._plant.tilt is not None else self._config.gripper.finger_mass * physics.engine_rate
        )
        return stepper(self._client.number, self.body, self.gripper, self.rows, physics.engine_steps, inertia)

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
        return EngineState(save_engine(client), box, self.reading)

    def set_state(self, state: EngineState) -> None:
        """Restore a state, also one of another world or process; the plant's arrays are not changed.

        Raises:
            RuntimeError: The world is closed.
        """
        client = self._rebuilt(state.box)
        load_engine(client, state.engine)
        self.reading = state.reading
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
        if built is None or replace(built, mass=box.mass, inertia=box.inertia) != box:
            self._build(box)
        self._set_mass(box.mass, box.inertia)
        return client

    def _set_mass(self, mass: float, inertia: float) -> None:
        if (mass, inertia) != self._mass_set:
            scene.set_mass(self.client, self.body, mass, inertia, self._plant.tilt is not None)
            self._mass_set = mass, inertia

    def _place_links(self, client: int) -> None:
        """Make the engine compute the poses of the gripper's links from its joints.

        A step and a restore round these poses differently. Computed by the same function after both, a
        restored world continues bit for bit. Setting any joint to its own value is enough.
        """
        _, _, positions, _, speeds = self.reading
        p.resetJointState(self.gripper, WRIST_JOINTS[0], positions[0], speeds[0], client)

    def _build(self, box: Box) -> None:
        client = self.client
        self._mass_set = None
        self.__dict__.pop("_advance", None)
        self._client.unmark()
        scene.clear(client, self._config)
        self.gripper = scene.add_gripper(client, self._config, box.size[1])
        self._client.mark(self.gripper)
        self.body = scene.add_box(client, box)
        if self._plant.tilt is None:
            self._saved = scene.settle(client, self._config, self.gripper)
        else:
            self._saved = scene.release(client, self.gripper, self.body)

    def _place(self, wrist: tuple[float, float, float]) -> None:
        client = self.client
        for joint, position in zip(WRIST_JOINTS, wrist, strict=True):
            p.resetJointState(self.gripper, joint, position, 0.0, physicsClientId=client)
        x, z = self._plant.world["com"][0]
        half = -0.5 * wrist[2]
        y, attitude = 0.0, [0.0, math.sin(half), 0.0, math.cos(half)]
        tilt = self._plant.tilt
        if tilt is not None:
            y, attitude = tilt["height"].item(), tilt["attitude"][0]
            for joint in FINGER_LINKS:
                p.resetJointState(self.gripper, joint, tilt["closure"].item(), 0.0, physicsClientId=client)
        p.resetBasePositionAndOrientation(self.body, [x, y, z], attitude, physicsClientId=client)
