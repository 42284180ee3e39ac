"""Runs the bare PyBullet scene with the fewest calls that any such environment needs, as a lower bound.

The same bodies at the same rate and solver settings, and per engine step what no simulation
of in-hand slip with friction of its own can leave out: load on the object, reactions on two
fingers, finger efforts, wrist motors, the step, pose, velocity, joints.
No friction, no sensors, no bookkeeping; what is sent is constant and what comes is dropped.
"""

from __future__ import annotations

import math

from slipgym.config import Config
from slipgym.world import scene
from slipgym.world.quiet_pybullet import p
from slipgym.world.scene import FINGER_LINKS, JOINTS, WRIST_FORCE, WRIST_JOINTS, Box


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
        self._weight = box.mass * config.physics.gravity
        self._efforts = (force, force)
        self._points = tuple((0.0, side * box.size[1] / 2, 0.0) for side in (1.0, -1.0))

    def run(self, steps: int) -> None:
        """Advance by a number of engine steps."""
        client, body, gripper = self._client, self._body, self._gripper
        push, twist, advance = p.applyExternalForce, p.applyExternalTorque, p.stepSimulation
        drive, world = p.setJointMotorControlArray, p.WORLD_FRAME
        pose, velocity, joints = p.getBasePositionAndOrientation, p.getBaseVelocity, p.getJointStates
        (first, second), (at_first, at_second) = FINGER_LINKS, self._points
        up, down = (0.0, 0.0, self._weight), (0.0, 0.0, -0.5 * self._weight)
        origin = none = (0.0, 0.0, 0.0)
        effort = {"controlMode": p.TORQUE_CONTROL, "forces": self._efforts, "physicsClientId": client}
        motion = {
            "controlMode": p.VELOCITY_CONTROL,
            "targetVelocities": none,
            "forces": WRIST_FORCE,
            "physicsClientId": client,
        }
        for _ in range(steps):
            push(body, -1, up, origin, world, client)
            twist(body, -1, none, world, client)
            push(gripper, first, down, at_first, world, client)
            twist(gripper, first, none, world, client)
            push(gripper, second, down, at_second, world, client)
            twist(gripper, second, none, world, client)
            drive(gripper, FINGER_LINKS, **effort)
            drive(gripper, WRIST_JOINTS, **motion)
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
