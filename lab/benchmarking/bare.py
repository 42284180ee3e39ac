"""Runs the bare PyBullet scene with the fewest calls that any such environment needs, as a lower bound.

The same bodies at the same rate and solver settings, and per engine step what no simulation
of in-hand slip with friction of its own can leave out: load on the object, reactions on two
fingers, finger efforts, wrist motors, the step, pose, velocity, joints.
No friction, no sensors, no bookkeeping; what is sent is constant and what comes is dropped.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import repeat

from slipgym.config import Config
from slipgym.world import scene
from slipgym.world.quiet_pybullet import p
from slipgym.world.scene import FINGER_LINKS, JOINTS, WRIST_FORCE, WRIST_JOINTS, Box, load_engine


class BareLoop:
    """Engine steps of a held box whose weight is carried by a constant load.

    Args:
        config: Configuration; gripper, object and physics are read.
        force: Effort of each finger [N].
    """

    def __init__(self, config: Config, force: float = 5.0) -> None:
        thing = config.object
        box = Box(thing.size, thing.com_offset, thing.grasp_offset, thing.mass, thing.grip_axis_inertia)
        self._client = scene.connect()
        scene.clear(self._client, config)
        self._gripper = scene.add_gripper(self._client, config, box.size[1])
        self._body = scene.add_box(self._client, box)
        scene.settle(self._client, config, self._gripper)
        scene.set_mass(self._client, self._body, box.mass, box.inertia)
        weight, side, none = box.mass * config.physics.gravity, box.size[1] / 2, (0.0, 0.0, 0.0)
        half = 0.0, 0.0, -0.5 * weight
        self._constant = (
            ((0.0, 0.0, weight), none),
            ((0.0, side, 0.0), half, none),
            ((0.0, -side, 0.0), half, none),
            (force, force),
            none,
        )

    def run(self, steps: int) -> None:
        """Advance by a number of engine steps."""
        self.replay(repeat(self._constant, steps))

    def load(self, state: bytes) -> None:
        """Restore the state of an environment's engine, from `slipgym.world.scene.save_engine`."""
        load_engine(self._client, state)

    def replay(self, loads: Iterable[tuple]) -> None:
        """Advance by one engine step for each of some loads.

        Args:
            loads: As `slipgym.world.bullet_rows.loads` returns them: force and torque on the object; place,
                force and torque on either finger; efforts of the fingers; velocities of the wrist.
        """
        client, body, gripper = self._client, self._body, self._gripper
        push, twist, advance = p.applyExternalForce, p.applyExternalTorque, p.stepSimulation
        drive, world = p.setJointMotorControlArray, p.WORLD_FRAME
        pose, velocity, joints = p.getBasePositionAndOrientation, p.getBaseVelocity, p.getJointStates
        first, second = FINGER_LINKS
        origin = pose(body, client)[0]
        effort = {"controlMode": p.TORQUE_CONTROL, "physicsClientId": client}
        motion = {"controlMode": p.VELOCITY_CONTROL, "forces": WRIST_FORCE, "physicsClientId": client}
        for (force, torque), at_first, at_second, efforts, speeds in loads:
            push(body, -1, force, origin, world, client)
            twist(body, -1, torque, world, client)
            push(gripper, first, at_first[1], at_first[0], world, client)
            twist(gripper, first, at_first[2], world, client)
            push(gripper, second, at_second[1], at_second[0], world, client)
            twist(gripper, second, at_second[2], world, client)
            drive(gripper, FINGER_LINKS, forces=efforts, **effort)
            drive(gripper, WRIST_JOINTS, targetVelocities=speeds, **motion)
            advance(client)
            origin = pose(body, client)[0]
            velocity(body, client)
            joints(gripper, JOINTS, client)

    def held(self) -> bool:
        """Whether the box is where it was and both fingers touch it."""
        position, _ = p.getBasePositionAndOrientation(self._body, self._client)
        points = p.getContactPoints(self._body, self._gripper, physicsClientId=self._client)
        return math.dist(position, (0.0, 0.0, 0.0)) < 1e-3 and {point[4] for point in points} == {
            *FINGER_LINKS
        }

    def close(self) -> None:
        """Release the physics client."""
        p.disconnect(self._client)
