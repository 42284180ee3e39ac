"""Creates the bodies of the PyBullet scene: a gripper on a moving wrist, and a box between its pads.

Pads and box have no friction of Bullet's own and no damping; the box's frame is its
centre of mass. Nothing is read from files, so an episode can change the box cheaply.
"""

from __future__ import annotations

import math
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from slipgym.config import Config
from slipgym.config.hardware import box_inertia
from slipgym.world.actuator import FINGER_DAMPING
from slipgym.world.quiet_pybullet import p

WRIST_JOINTS = (0, 1, 2)
FINGER_LINKS = (3, 4)
JOINTS = (*WRIST_JOINTS, *FINGER_LINKS)
WRIST_FORCE = (1e4, 1e4, 1e3)
PAD_THICKNESS = 0.01
_NO_ROTATION = (0.0, 0.0, 0.0, 1.0)
_WRIST_MASS = 1.0
_SETTLE_STEPS = 60
_SETTLE_FORCES = (5.0, 5.0)
_NAME = "world.bullet"
_SETTLE_MASS = 0.2  # whichever mass the first episode has, the saved state is the same


@dataclass(frozen=True)
class Box:
    """A box by its geometry and mass distribution; x and z span the contact plane."""

    size: tuple[float, float, float]
    """Extent along x, the grip axis and z [m]."""
    com_offset: tuple[float, float]
    """Centre of mass (x, z) from the geometric centre [m]."""
    grasp_offset: tuple[float, float]
    """Pad centre (x, z) at the grasp from the geometric centre [m]."""
    mass: float
    """[kg]."""
    inertia: float
    """Moment of inertia about the grip axis through the centre of mass [kg m^2]."""

    @property
    def grasp_from_com(self) -> tuple[float, float]:
        """Pad centre (x, z) at the grasp from the centre of mass [m]."""
        return self.grasp_offset[0] - self.com_offset[0], self.grasp_offset[1] - self.com_offset[1]


@dataclass(frozen=True)
class EngineState:
    """Plain data that the engine's next step depends on."""

    engine: bytes
    """Bullet's own file of its bodies: poses, velocities and contacts, bit for bit."""
    box: Box
    """The box of the episode."""
    reading: tuple[Any, ...]
    """`BulletWorld.reading` at that time."""


def connect() -> int:
    """Start a physics client of our own.

    Raises:
        RuntimeError: PyBullet has no client left.
    """
    client = p.connect(p.DIRECT)
    if client < 0:
        raise RuntimeError("PyBullet refused another physics client; close environments that are done")
    return client


def clear(client: int, config: Config) -> None:
    """Empty the world and set its rate and solver.

    The solver goes through all its iterations: by default it stops at a residual that leaves normal forces
    wrong by 3e-4. Contacts have no friction of the engine's, so its cone is a waste of time.
    """
    p.resetSimulation(physicsClientId=client)
    p.setPhysicsEngineParameter(
        fixedTimeStep=1.0 / config.physics.engine_rate,
        numSolverIterations=config.physics.solver_iterations,
        numSubSteps=0,
        solverResidualThreshold=0.0,
        enableConeFriction=0,
        deterministicOverlappingPairs=1,
        physicsClientId=client,
    )


def add_gripper(client: int, config: Config, thickness: float) -> int:
    """Create wrist (x, z, pitch about -y) and two fingers that close on a box of this thickness."""
    side = config.gripper.pad_radius * math.sqrt(0.5)  # square inscribed in the pad's disc
    depth = PAD_THICKNESS / 2
    pad = p.createCollisionShape(p.GEOM_BOX, halfExtents=[side, depth, side], physicsClientId=client)
    look = p.createVisualShape(
        p.GEOM_CYLINDER,
        radius=config.gripper.pad_radius,
        length=PAD_THICKNESS,
        rgbaColor=[0.25, 0.28, 0.33, 1.0],
        visualFrameOrientation=p.getQuaternionFromEuler([math.pi / 2, 0, 0]),
        physicsClientId=client,
    )
    offset = thickness / 2 + depth
    gripper = p.createMultiBody(
        baseMass=0,
        linkMasses=[_WRIST_MASS] * 3 + [config.gripper.finger_mass] * 2,
        linkCollisionShapeIndices=[-1, -1, -1, pad, pad],
        linkVisualShapeIndices=[-1, -1, -1, look, look],
        linkPositions=[[0, 0, 0]] * 3 + [[0, offset, 0], [0, -offset, 0]],
        linkOrientations=[_NO_ROTATION] * 5,
        linkInertialFramePositions=[[0, 0, 0]] * 5,
        linkInertialFrameOrientations=[_NO_ROTATION] * 5,
        linkParentIndices=[0, 1, 2, 3, 3],
        linkJointTypes=[p.JOINT_PRISMATIC] * 2 + [p.JOINT_REVOLUTE] + [p.JOINT_PRISMATIC] * 2,
        linkJointAxis=[[1, 0, 0], [0, 0, 1], [0, -1, 0], [0, -1, 0], [0, 1, 0]],
        physicsClientId=client,
    )
    for link in range(-1, 5):
        _frictionless(client, gripper, link)
    for link in FINGER_LINKS:
        p.changeDynamics(gripper, link, jointDamping=FINGER_DAMPING, physicsClientId=client)
    # Bullet starts every joint with a velocity motor; the fingers' must not resist
    p.setJointMotorControlArray(
        gripper, FINGER_LINKS, p.VELOCITY_CONTROL, forces=[0.0, 0.0], physicsClientId=client
    )
    return gripper


def add_box(client: int, box: Box) -> int:
    """Create the box with its grasp point at the origin; `set_mass` gives it its mass."""
    half = [extent / 2 for extent in box.size]
    centre = [-box.com_offset[0], 0.0, -box.com_offset[1]]
    shape = p.createCollisionShape(
        p.GEOM_BOX, halfExtents=half, collisionFramePosition=centre, physicsClientId=client
    )
    look = p.createVisualShape(
        p.GEOM_BOX,
        halfExtents=half,
        visualFramePosition=centre,
        rgbaColor=[0.85, 0.62, 0.38, 1.0],
        physicsClientId=client,
    )
    x, z = box.grasp_from_com
    body = p.createMultiBody(
        _SETTLE_MASS, shape, look, [-x, 0.0, -z], useMaximalCoordinates=1, physicsClientId=client
    )
    _frictionless(client, body, -1)
    set_mass(client, body, _SETTLE_MASS, box_inertia(_SETTLE_MASS, box.size[0], box.size[2]))
    return body


def settle(client: int, config: Config, gripper: int) -> int:
    """Press the pads on the box without gravity until the normal contact rests.

    Returns:
        PyBullet's id of the saved state; gravity acts again.
    """
    p.setGravity(0.0, 0.0, 0.0, physicsClientId=client)
    p.setJointMotorControlArray(
        gripper, WRIST_JOINTS, p.VELOCITY_CONTROL, forces=WRIST_FORCE, physicsClientId=client
    )
    for _ in range(_SETTLE_STEPS):
        p.setJointMotorControlArray(
            gripper, FINGER_LINKS, p.TORQUE_CONTROL, forces=_SETTLE_FORCES, physicsClientId=client
        )
        p.stepSimulation(physicsClientId=client)
    p.setGravity(0.0, 0.0, -config.physics.gravity, physicsClientId=client)
    return p.saveState(physicsClientId=client)


def release(client: int, gripper: int, body: int) -> int:
    """Turn off gravity and the contact between pads and box, which are computed for an object that may tilt.

    Returns:
        PyBullet's id of the saved state.
    """
    p.setGravity(0.0, 0.0, 0.0, physicsClientId=client)
    for link in FINGER_LINKS:
        p.setCollisionFilterPair(body, gripper, -1, link, 0, physicsClientId=client)
    p.setJointMotorControlArray(
        gripper, JOINTS, p.VELOCITY_CONTROL, forces=(*WRIST_FORCE, *WRIST_FORCE[:2]), physicsClientId=client
    )
    p.stepSimulation(physicsClientId=client)
    return p.saveState(physicsClientId=client)


def set_mass(client: int, body: int, mass: float, inertia: float, tilt: bool = False) -> None:
    """Give the body a mass [kg] and a moment of inertia about the grip axis [kg m^2].

    About the other axes it is infinite, for which Bullet takes 0: flat pads do not let a box tilt. With
    `tilt` it is the same about all, see `slipgym.world.tilt_coupling`. Bullet turns a body with a new inertia
    from the end of a step on: here one is taken, and taken back.
    """
    state = p.saveState(physicsClientId=client)
    diagonal = (inertia, inertia, inertia) if tilt else (0.0, inertia, 0.0)
    p.changeDynamics(body, -1, mass=mass, localInertiaDiagonal=diagonal, physicsClientId=client)
    p.stepSimulation(physicsClientId=client)
    p.restoreState(stateId=state, physicsClientId=client)
    p.removeState(state, physicsClientId=client)


def save_engine(client: int) -> bytes:
    """State of the bodies of a client, as the content of a file."""
    with tempfile.TemporaryDirectory(prefix="slipgym-") as folder:
        path = Path(folder) / _NAME
        p.saveBullet(str(path), physicsClientId=client)
        return path.read_bytes()


def load_engine(client: int, content: bytes) -> None:
    """Restore what `save_engine` returned; the client's bodies were created in the same order.

    Bullet checks nothing of what it reads, so that a crafted file may crash the process: the checksums of a
    state are compared before.
    """
    with tempfile.TemporaryDirectory(prefix="slipgym-") as folder:
        path = Path(folder) / _NAME
        path.write_bytes(content)
        p.restoreState(fileName=str(path), physicsClientId=client)


def _frictionless(client: int, body: int, link: int) -> None:
    p.changeDynamics(
        body,
        link,
        lateralFriction=0.0,
        spinningFriction=0.0,
        rollingFriction=0.0,
        linearDamping=0.0,
        angularDamping=0.0,
        jointDamping=0.0,
        maxJointVelocity=1e3,
        physicsClientId=client,
    )
