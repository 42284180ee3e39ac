"""MuJoCo as a rig: elliptic cones, with the settings that its documentation names against slip."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from lab.suite.rig import FINGER_MASS, MU, SIZE, Grasp, R, Variant, library

STEP = 0.002
"""MuJoCo's default step [s]."""
WRIST_MASS = 1e6
"""So heavy that the grasp does not move the wrist [kg]."""
PAD_DEPTH = 0.005
"""Half the thickness of a flat pad [m]."""
_MODEL = """
<mujoco>
  <option timestep="{step}" integrator="implicitfast" cone="elliptic" gravity="0 0 0" solver="Newton"
          tolerance="1e-10" impratio="{impratio}" noslip_iterations="{noslip}"/>
  <worldbody>
    <body>
      <inertial pos="0 0 0" mass="{wrist}" diaginertia="1 1 1"/>
      <joint name="x" type="slide" axis="1 0 0"/>
      <joint name="z" type="slide" axis="0 0 1"/>
      <body pos="0 {offset} 0">
        <inertial pos="0 0 0" mass="{finger}" diaginertia="1e-4 1e-4 1e-4"/>
        <joint name="first" type="slide" axis="0 -1 0"/>
        <geom {pad}/>
      </body>
      <body pos="0 -{offset} 0">
        <inertial pos="0 0 0" mass="{finger}" diaginertia="1e-4 1e-4 1e-4"/>
        <joint name="second" type="slide" axis="0 1 0"/>
        <geom {pad}/>
      </body>
    </body>
    <body>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="{inertia} {inertia} {inertia}"/>
      <joint name="object_x" type="slide" axis="1 0 0"/>
      <joint name="object_z" type="slide" axis="0 0 1"/>
      <joint name="object_y" type="slide" axis="0 1 0"/>
      <joint name="angle" type="hinge" axis="0 -1 0"/>
      <geom type="box" size="{half}"/>
    </body>
  </worldbody>
</mujoco>
"""

FINGER_JOINTS = slice(2, 4)
"""Of the joints, which are wrist x and z, the fingers, and x, z, y and angle of the object."""
OBJECT_JOINTS = [4, 5, 7]
"""x, z and angle of the object."""


def pad(points: int) -> tuple[str, float]:
    """Geometry of a pad, and the distance of its centre from the object's surface [m].

    Args:
        points: 1 for a sphere with torsional friction mu r, 4 for the corners of a square at the
            distance r, which have no torsional friction. Either carries the torque mu f_n r in pure spin.
    """
    if points == 1:
        return f'type="sphere" size="0.015" condim="4" priority="1" friction="{MU} {MU * R} 0.0001"', 0.015
    side = R * math.sqrt(0.5)
    size = f"{side} {PAD_DEPTH} {side}"
    return f'type="box" size="{size}" condim="3" priority="1" friction="{MU} 0 0"', PAD_DEPTH


def model_text(grasp: Grasp, impratio: float, noslip: int, points: int) -> str:
    """The model in MuJoCo's XML; arguments as `MujocoRig`."""
    geometry, depth = pad(points)
    return _MODEL.format(
        step=STEP,
        impratio=impratio,
        noslip=noslip,
        wrist=WRIST_MASS,
        finger=FINGER_MASS,
        offset=0.5 * SIZE[1] + depth,
        pad=geometry,
        mass=grasp.mass,
        inertia=grasp.inertia,
        half=" ".join(str(0.5 * extent) for extent in SIZE),
    )


class MujocoRig:
    """A grasp in MuJoCo; the object moves along x, y, z and turns about the grip axis.

    Args:
        grasp: Object and grip.
        impratio: Ratio of frictional to normal impedance [-].
        noslip: Iterations of the solver that suppresses slip.
        points: Contact points of a pad, 1 or 4, as `pad`.

    Raises:
        RuntimeError: MuJoCo is not installed.
    """

    def __init__(self, grasp: Grasp, impratio: float, noslip: int, points: int) -> None:
        mujoco = library("mujoco", "'slipgym[suite]'", "the engine mujoco")
        self._model = mujoco.MjModel.from_xml_string(model_text(grasp, impratio, noslip, points))
        self._data = mujoco.MjData(self._model)
        self._advance = mujoco.mj_step
        self._data.qfrc_applied[FINGER_JOINTS] = grasp.force
        self._heavy = WRIST_MASS + 2.0 * FINGER_MASS
        self.step_time = STEP

    def step(self, load: np.ndarray, wrist: np.ndarray) -> None:
        """Advance by one step of MuJoCo."""
        data = self._data
        data.qfrc_applied[:2] = self._heavy * (wrist - data.qvel[:2]) / STEP
        data.qfrc_applied[OBJECT_JOINTS] = load
        self._advance(self._model, data)

    def throw(self, velocity: np.ndarray) -> None:
        """Set the object's joint velocities."""
        self._data.qvel[OBJECT_JOINTS] = velocity

    @property
    def position(self) -> np.ndarray:
        """Centre of mass and angle, (3,) [m, m, rad]."""
        return self._data.qpos[OBJECT_JOINTS]

    @property
    def velocity(self) -> np.ndarray:
        """Velocity of them, (3,) [m/s, m/s, rad/s]."""
        return self._data.qvel[OBJECT_JOINTS]

    @property
    def wrist(self) -> np.ndarray:
        """Pad centre (x, z), (2,) [m]."""
        return self._data.qpos[:2].copy()

    def close(self) -> None:
        """There is nothing to release."""


def variants() -> list[Variant]:
    """Impedance ratios without and with the no-slip solver."""
    rows = [(impratio, noslip, 1) for impratio in (1, 10, 100) for noslip in (0, 10)] + [
        (100, 0, 4),
        (100, 10, 4),
    ]
    return [
        Variant(
            "mujoco",
            f"impratio {impratio}" + f", noslip {noslip}" * (noslip > 0) + ", 4 points" * (points == 4),
            partial(MujocoRig, impratio=impratio, noslip=noslip, points=points),
            drawn=(impratio, noslip, points) == (100, 10, 1),
        )
        for impratio, noslip, points in rows
    ]
