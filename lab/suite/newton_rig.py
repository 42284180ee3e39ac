"""Newton as a rig: its MuJoCo-Warp solver on the processor, on the model of `mujoco_rig`."""

from __future__ import annotations

from functools import partial

import numpy as np

from lab.suite.mujoco_rig import (
    FINGER_JOINTS,
    OBJECT_JOINTS,
    STEP,
    WRIST_MASS,
    model_text,
)
from lab.suite.rig import FINGER_MASS, Grasp, Variant, library


class NewtonRig:
    """A grasp in Newton's `SolverMuJoCo`; in single precision, which is Newton's.

    Args:
        grasp: Object and grip.
        impratio: Ratio of frictional to normal impedance [-].
        points: Contact points of a pad, 1 or 4, as `mujoco_rig.pad`.

    Raises:
        RuntimeError: Newton or its MuJoCo-Warp is not installed.
    """

    def __init__(self, grasp: Grasp, impratio: float, points: int) -> None:
        load = partial(library, package="'newton[sim]'", purpose="the engine newton")
        load("warp").config.log_level = load("logging").WARNING
        newton, solvers = load("newton"), load("newton.solvers")
        load("mujoco_warp")
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
        solvers.SolverMuJoCo.register_custom_attributes(builder)
        builder.add_mjcf(model_text(grasp, impratio, 0, points))
        model = builder.finalize(device="cpu")
        self._solver = solvers.SolverMuJoCo(model, cone="elliptic", impratio=impratio)
        self._state, self._next = model.state(), model.state()
        self._control = model.control()
        self._forces = self._control.joint_f.numpy()
        self._forces[FINGER_JOINTS] = grasp.force
        self._heavy = WRIST_MASS + 2.0 * FINGER_MASS
        self.step_time = STEP
        self._read()

    def _read(self) -> None:
        self._positions = self._state.joint_q.numpy().astype(float)
        self._velocities = self._state.joint_qd.numpy().astype(float)

    def step(self, load: np.ndarray, wrist: np.ndarray) -> None:
        """Advance by one step."""
        self._forces[:2] = self._heavy * (wrist - self._velocities[:2]) / STEP
        self._forces[OBJECT_JOINTS] = load
        self._state.clear_forces()
        self._solver.step(self._state, self._next, self._control, None, STEP)
        self._state, self._next = self._next, self._state
        self._read()

    def throw(self, velocity: np.ndarray) -> None:
        """Set the object's joint velocities."""
        self._state.joint_qd.numpy()[OBJECT_JOINTS] = velocity
        self._read()

    @property
    def position(self) -> np.ndarray:
        """Centre of mass and angle, (3,) [m, m, rad]."""
        return self._positions[OBJECT_JOINTS]

    @property
    def velocity(self) -> np.ndarray:
        """Velocity of them, (3,) [m/s, m/s, rad/s]."""
        return self._velocities[OBJECT_JOINTS]

    @property
    def wrist(self) -> np.ndarray:
        """Pad centre (x, z), (2,) [m]."""
        return self._positions[:2]

    def close(self) -> None:
        """There is nothing to release."""


def variants() -> list[Variant]:
    """The solver with the settings that its tuning guide names for grasps."""
    settings = "MuJoCo-Warp solver, impratio 100"
    return [Variant("newton", settings, partial(NewtonRig, impratio=100, points=1), drawn=True)]
