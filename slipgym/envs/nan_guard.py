"""Detects the first number that is not finite, and writes the control steps before it to a file."""

from __future__ import annotations

import io
import math
import tempfile
import uuid
from pathlib import Path
from typing import NamedTuple, NoReturn

import numpy as np

from slipgym import atomic_io
from slipgym._numba.compiled import compiled
from slipgym.envs.readings import finite_check, row_writer

KEPT = 120
"""Number of control steps whose quantities are kept: one second."""


class Quantity(NamedTuple):
    """One number that is checked."""

    name: str
    unit: str
    read: str
    """Expression for environment i in terms of the arguments of `note`."""
    measured: bool = False
    """Whether it is a measurement, which is finite if the measured quantity is."""


def _loads(f: int) -> tuple[Quantity, ...]:
    """Forces on finger 1 or 2."""
    pad = f"pads[i, {f - 1}]"
    return (
        Quantity(f"normal_force_{f}", "N", f"{pad}.normal"),
        Quantity(f"grip_force_{f}", "N", f"fingers[i, {f - 1}].force"),
        Quantity(f"friction_x_{f}", "N", f"{pad}.wrench[0]"),
        Quantity(f"friction_y_{f}", "N", f"{pad}.wrench[1]"),
        Quantity(f"friction_tau_{f}", "N m", f"{pad}.wrench[2]"),
    )


def _measurements(f: int) -> tuple[Quantity, ...]:
    """Sensor readings of finger 1 or 2."""
    wrench, twist = f"wrenches[i, {f - 1}, ", f"twists[i, {f - 1}, "
    return (
        Quantity(f"measured_f_x_{f}", "N", f"{wrench}0]", measured=True),
        Quantity(f"measured_f_y_{f}", "N", f"{wrench}1]", measured=True),
        Quantity(f"measured_f_n_{f}", "N", f"{wrench}2]", measured=True),
        Quantity(f"measured_tau_{f}", "N m", f"{wrench}3]", measured=True),
        Quantity(f"measured_v_x_{f}", "m/s", f"{twist}0]", measured=True),
        Quantity(f"measured_v_y_{f}", "m/s", f"{twist}1]", measured=True),
        Quantity(f"measured_omega_{f}", "rad/s", f"{twist}2]", measured=True),
    )


def _estimates(f: int) -> tuple[Quantity, ...]:
    """Estimates of finger 1 or 2."""
    estimate = f"per_finger[i, {f - 1}, "
    return (
        Quantity(f"estimated_mu_s_{f}", "-", f"{estimate}0]"),
        Quantity(f"estimated_mu_c_{f}", "-", f"{estimate}1]"),
        Quantity(f"estimated_r_{f}", "m", f"{estimate}2]"),
    )


QUANTITIES = (
    Quantity("object_x", "m", "worlds[i].com[0]"),
    Quantity("object_z", "m", "worlds[i].com[1]"),
    Quantity("object_angle", "rad", "worlds[i].angle"),
    Quantity("object_v_x", "m/s", "worlds[i].velocity[0]"),
    Quantity("object_v_z", "m/s", "worlds[i].velocity[1]"),
    Quantity("object_omega", "rad/s", "worlds[i].velocity[2]"),
    Quantity("wrist_x", "m", "worlds[i].wrist[0]"),
    Quantity("wrist_z", "m", "worlds[i].wrist[1]"),
    Quantity("wrist_pitch", "rad", "worlds[i].wrist[2]"),
    Quantity("disturbance_x", "N", "worlds[i].external[0]"),
    Quantity("disturbance_z", "N", "worlds[i].external[1]"),
    Quantity("disturbance_torque", "N m", "worlds[i].external[2]"),
    *_loads(1),
    *_loads(2),
    *_measurements(1),
    *_measurements(2),
    *_estimates(1),
    *_estimates(2),
    Quantity("reward", "-", "episodes[i].terms.sum()"),
)
"""Quantities that are checked, causes before effects: the error names the first one that is not finite."""

_NAMES = tuple(quantity.name for quantity in QUANTITIES)
_ARRAYS = "worlds", "pads", "fingers", "wrenches", "twists", "per_finger", "episodes"
_write_quantities = row_writer(
    "_write_quantities",
    [quantity.read for quantity in QUANTITIES],
    _ARRAYS,
    __file__,
    "Write `QUANTITIES` of environment i.",
)
sound = finite_check(
    "sound",
    [quantity.read for quantity in QUANTITIES if not quantity.measured],
    ("worlds", "pads", "fingers", "per_finger", "episodes"),
    __file__,
    "Whether the `QUANTITIES` of environment i are finite; measurements are left out.",
)


@compiled
def note(row, i, worlds, pads, fingers, wrenches, twists, per_finger, episodes):
    """Write the quantities of environment i.

    Args:
        row: Output (len(QUANTITIES),).
        i: Index of the environment.
        worlds: WORLD (n,).
        pads: PAD (n, 2).
        fingers: FINGER (n, 2).
        wrenches: Measured wrenches (n, 2, 4) [N, N, N, N m].
        twists: Measured twists (n, 2, 3) [m/s, m/s, rad/s].
        per_finger: Estimated mu_s, mu_c, r (n, 2, 3).
        episodes: EPISODE (n,), for the reward terms.

    Returns:
        Index of the first quantity that is not finite; -1 if there is none.
    """
    _write_quantities(row, i, worlds, pads, fingers, wrenches, twists, per_finger, episodes)
    for k in range(row.shape[0]):
        if not math.isfinite(row[k]):
            return k
    return -1


class Guard:
    """Keeps the quantities of the last control steps; stops a simulation in which one is not finite."""

    def __init__(self) -> None:
        self._rows = np.zeros((KEPT, len(QUANTITIES)))
        self._times = np.zeros(KEPT)
        self._count = 0

    def reset(self) -> None:
        """Forget the last episode."""
        self._count = 0

    def watch(self, time: float, i: int, *arrays: np.ndarray) -> None:
        """Store the quantities of a control step.

        Args:
            time: [s].
            i: Index of the environment.
            *arrays: Arrays of the environments, in the order of `note`.

        Raises:
            FloatingPointError: A quantity is not finite. The message names the first one and the file that
                the kept control steps were written to.
        """
        at = self._count % KEPT
        self._count += 1
        self._times[at] = time
        bad = note(self._rows[at], i, *arrays)
        if bad >= 0:
            self._stop(_NAMES[bad], self._rows[at, bad], time)

    def _stop(self, name: str, value: float, time: float) -> NoReturn:
        kept = min(self._count, KEPT)
        order = np.arange(self._count - kept, self._count) % KEPT
        table = np.column_stack([self._times[order], self._rows[order]])
        text = io.StringIO()
        np.savetxt(text, table, delimiter=",", header="time," + ",".join(_NAMES), comments="")
        csv = Path(tempfile.gettempdir(), f"slipgym-{uuid.uuid4().hex}.csv")
        atomic_io.write(csv, text.getvalue().encode())
        raise FloatingPointError(
            f"{name} is {value} at t = {time:g} s; the last {kept} samples are in {csv}; "
            "reset() starts afresh"
        )
