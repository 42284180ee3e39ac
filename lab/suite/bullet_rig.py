"""Bullet's own friction as a rig, through PyBullet."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from lab.suite.rig import FINGER_MASS, MU, SIZE, Grasp, R, Variant
from slipgym.world import scene
from slipgym.world.quiet_pybullet import p

WRIST, FINGERS = (0, 1), (2, 3)
"""Joints: wrist x and z, fingers."""
OBJECT = (0, 1, 3)
"""Joints of the object: x, z, angle."""
_TINY = 1e-6  # [kg]
_SPHERE = 0.015  # [m]
_DEPTH = 0.005  # [m], half the thickness of a flat pad


@dataclass(frozen=True)
class Settings:
    """How Bullet computes contact."""

    rate: int = 240
    """Steps per second [Hz]; 240 is PyBullet's default."""
    iterations: int = 50
    """Iterations of the solver; 50 is PyBullet's default."""
    points: int = 1
    """Contact points of a pad: 1, a sphere with spinning friction mu r, or 4, corners at the distance r."""
    anchor: bool = False
    """Whether friction anchors correct positions; they come with soft contact."""


def _chain(n: int) -> dict[str, Any]:
    """Arguments of `createMultiBody` for n links without pictures, all in one orientation."""
    return {
        "linkVisualShapeIndices": [-1] * n,
        "linkOrientations": [(0.0, 0.0, 0.0, 1.0)] * n,
        "linkInertialFramePositions": [[0, 0, 0]] * n,
        "linkInertialFrameOrientations": [(0.0, 0.0, 0.0, 1.0)] * n,
    }


class BulletRig:
    """A grasp in Bullet; the object moves along x, y, z and turns about the grip axis.

    Args:
        grasp: Object and grip.
        settings: How Bullet computes contact.
    """

    def __init__(self, grasp: Grasp, settings: Settings) -> None:
        self._client = client = scene.connect()
        self.step_time = 1.0 / settings.rate
        self._force = grasp.force
        p.resetSimulation(physicsClientId=client)
        p.setPhysicsEngineParameter(
            fixedTimeStep=self.step_time,
            numSolverIterations=settings.iterations,
            numSubSteps=0,
            solverResidualThreshold=0.0,
            enableConeFriction=1,
            deterministicOverlappingPairs=1,
            physicsClientId=client,
        )
        self._gripper = self._add_gripper(settings)
        self._object = self._add_object(grasp)
        self._read()

    def _add_object(self, grasp: Grasp) -> int:
        """A chain of joints x, z, y and angle, of which only the last moves a mass worth mentioning."""
        client = self._client
        half = [0.5 * extent for extent in SIZE]
        box = p.createCollisionShape(p.GEOM_BOX, halfExtents=half, physicsClientId=client)
        body = p.createMultiBody(
            baseMass=0,
            linkMasses=[_TINY, _TINY, _TINY, grasp.mass],
            linkCollisionShapeIndices=[-1, -1, -1, box],
            linkParentIndices=[0, 1, 2, 3],
            linkJointTypes=[p.JOINT_PRISMATIC] * 3 + [p.JOINT_REVOLUTE],
            linkJointAxis=[[1, 0, 0], [0, 0, 1], [0, 1, 0], [0, -1, 0]],
            linkPositions=[[0, 0, 0]] * 4,
            **_chain(4),
            physicsClientId=client,
        )
        self._calm(body)
        inertia = [grasp.inertia] * 3
        friction = {"lateralFriction": 1.0, "spinningFriction": 0.0, "rollingFriction": 0.0}
        p.changeDynamics(body, 3, localInertiaDiagonal=inertia, physicsClientId=client, **friction)
        return body

    def _calm(self, body: int) -> None:
        """Take damping and motors from a body of four joints."""
        still = dict.fromkeys(("linearDamping", "angularDamping", "jointDamping"), 0.0)
        for link in range(-1, 4):
            p.changeDynamics(body, link, maxJointVelocity=1e3, physicsClientId=self._client, **still)
        # Bullet starts every joint with a velocity motor
        p.setJointMotorControlArray(
            body, range(4), p.VELOCITY_CONTROL, forces=[0.0] * 4, physicsClientId=self._client
        )

    def _add_gripper(self, settings: Settings) -> int:
        client = self._client
        if settings.points == 1:
            depth, spinning = _SPHERE, MU * R
            pad = p.createCollisionShape(p.GEOM_SPHERE, radius=_SPHERE, physicsClientId=client)
        else:
            depth, spinning, side = _DEPTH, 0.0, R * math.sqrt(0.5)
            pad = p.createCollisionShape(p.GEOM_BOX, halfExtents=[side, depth, side], physicsClientId=client)
        offset = 0.5 * SIZE[1] + depth
        gripper = p.createMultiBody(
            baseMass=0,
            linkMasses=[1.0, 1.0, FINGER_MASS, FINGER_MASS],
            linkCollisionShapeIndices=[-1, -1, pad, pad],
            linkPositions=[[0, 0, 0], [0, 0, 0], [0, offset, 0], [0, -offset, 0]],
            linkParentIndices=[0, 1, 2, 2],
            linkJointTypes=[p.JOINT_PRISMATIC] * 4,
            linkJointAxis=[[1, 0, 0], [0, 0, 1], [0, -1, 0], [0, 1, 0]],
            **_chain(4),
            physicsClientId=client,
        )
        self._calm(gripper)
        contact = {"lateralFriction": MU, "spinningFriction": spinning, "rollingFriction": 0.0}
        if settings.anchor:
            contact |= {"frictionAnchor": 1, "contactStiffness": 1e5, "contactDamping": 1e2}
        for link in FINGERS:
            p.changeDynamics(
                gripper, link, jointDamping=scene.FINGER_DAMPING, physicsClientId=client, **contact
            )
        return gripper

    def step(self, load: np.ndarray, wrist: np.ndarray) -> None:
        """Advance by one step of Bullet."""
        client, drive = self._client, p.setJointMotorControlArray
        forces = (self._force, self._force)
        drive(self._object, OBJECT, p.TORQUE_CONTROL, forces=list(load), physicsClientId=client)
        drive(self._gripper, FINGERS, p.TORQUE_CONTROL, forces=forces, physicsClientId=client)
        drive(
            self._gripper,
            WRIST,
            p.VELOCITY_CONTROL,
            targetVelocities=list(wrist),
            forces=scene.WRIST_FORCE[:2],
            physicsClientId=client,
        )
        p.stepSimulation(client)
        self._read()

    def _read(self) -> None:
        states = p.getJointStates(self._object, OBJECT, self._client)
        self._position, self._velocity = np.array([state[:2] for state in states]).T
        self._wrist = np.array([state[0] for state in p.getJointStates(self._gripper, WRIST, self._client)])

    def throw(self, velocity: np.ndarray) -> None:
        """Set the object's joint velocities."""
        for joint, position, speed in zip(OBJECT, self._position, velocity, strict=True):
            p.resetJointState(self._object, joint, position, speed, physicsClientId=self._client)
        self._read()

    @property
    def position(self) -> np.ndarray:
        """Centre of mass and angle, (3,) [m, m, rad]."""
        return self._position

    @property
    def velocity(self) -> np.ndarray:
        """Velocity of them, (3,) [m/s, m/s, rad/s]."""
        return self._velocity

    @property
    def wrist(self) -> np.ndarray:
        """Pad centre (x, z), (2,) [m]."""
        return self._wrist

    def close(self) -> None:
        """Disconnect the client."""
        p.disconnect(physicsClientId=self._client)


def variants() -> list[Variant]:
    """One point or four, and the anchors."""
    rows = {
        "spinning friction": Settings(),
        "spinning friction, 1 kHz, 200 iterations": Settings(rate=1000, iterations=200),
        "4 points, anchors": Settings(points=4, anchor=True),
    }
    return [
        Variant("bullet", name, partial(BulletRig, settings=settings), drawn=name == "spinning friction")
        for name, settings in rows.items()
    ]
