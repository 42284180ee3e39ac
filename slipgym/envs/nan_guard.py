"""Detects the first number that is not finite, and writes the control steps before it to a file."""

from __future__ import annotations

import io
import math
import os
import uuid
from pathlib import Path
from typing import NamedTuple

import numpy as np

from estimator.own_folder import own_temporary_folder
from slipgym import atomic_io
from slipgym._numba.compiled import compiled, pointed
from slipgym._numba.generate import generate
from slipgym.envs.readings import of_state, row_writer

KEPT = 120
"""Number of control steps whose quantities are kept: one second."""
VARIABLE = "SLIPGYM_DUMPS"
"""Environment variable with their folder; without it, one of the user among the temporary files."""
FILES = 20
"""Newest files that the folder keeps."""


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
    wrench = ("f_x", "N"), ("f_y", "N"), ("f_n", "N"), ("tau", "N m")
    twist = ("v_x", "m/s"), ("v_y", "m/s"), ("omega", "rad/s")
    return tuple(
        Quantity(f"measured_{name}_{f}", unit, f"{array}[i, {f - 1}, {k}]", measured=True)
        for array, rows in (("wrenches", wrench), ("twists", twist))
        for k, (name, unit) in enumerate(rows)
    )


def _estimates(f: int) -> tuple[Quantity, ...]:
    """Estimates of finger 1 or 2."""
    named = enumerate((("mu_s", "-"), ("mu_c", "-"), ("r", "m")))
    return tuple(
        Quantity(f"estimated_{name}_{f}", unit, f"per_finger[i, {f - 1}, {k}]") for k, (name, unit) in named
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
    *(row for part in (_loads, _measurements, _estimates) for f in (1, 2) for row in part(f)),
    Quantity("reward", "-", "episodes[i].terms.sum()"),
)
"""Quantities that are checked, causes before effects: the error names the first one that is not finite."""

_NAMES = tuple(quantity.name for quantity in QUANTITIES)
_BEFORE = of_state("worlds", "pads", "fingers", "wrenches", "twists", "per_finger", "episodes")
_write_quantities = row_writer(
    "_write_quantities",
    [quantity.read for quantity in QUANTITIES],
    ("state",),
    __file__,
    "Write `QUANTITIES` of environment i.",
    _BEFORE,
)
_SUM = [f"total += {quantity.read}" for quantity in QUANTITIES if not quantity.measured]
sound = generate(
    "sound",
    ("i", "state"),
    [*_BEFORE, "total = 0.0", *_SUM, "return isfinite(total)"],
    {"isfinite": math.isfinite},
    compiled,
    __file__,
    "Whether the `QUANTITIES` of environment i are finite; measurements are left out.",
)


@pointed
def note(rows, at, state, i):
    """Write the time and the quantities of environment i of a `BatchState` to a row of `Guard.rows`.

    Returns:
        Place in the row of the first quantity that is not finite; 0 if there is none.
    """
    row, episode = rows[at], state.episodes[i]
    row[0] = episode.step * episode.step_time
    _write_quantities(row[1:], i, state)
    for k in range(1, row.shape[0]):
        if not math.isfinite(row[k]):
            return k
    return 0


class Guard:
    """Keeps the quantities of the last control steps; stops a simulation in which one is not finite.

    Attributes:
        rows: Time and `QUANTITIES` of control steps, (KEPT, 1 + len(QUANTITIES)).
    """

    def __init__(self) -> None:
        self.rows = np.zeros((KEPT, 1 + len(QUANTITIES)))
        self._count = 0

    def reset(self) -> None:
        """Forget the last episode."""
        self._count = 0

    def next(self) -> int:
        """The row for the next control step, which `note` writes."""
        self._count += 1
        return (self._count - 1) % KEPT

    def check(self, bad: int, where: str = "") -> None:
        """Write the kept control steps to a file if a quantity of the last one is not finite.

        Args:
            bad: What `note` returned for the last one.
            where: Begins the message.

        Raises:
            FloatingPointError: The message names the quantity, and the file.
        """
        if bad == 0:
            return
        kept = min(self._count, KEPT)
        time, *values = self.rows[(self._count - 1) % KEPT].tolist()
        name, value = _NAMES[bad - 1], values[bad - 1]
        order = np.arange(self._count - kept, self._count) % KEPT
        table = self.rows[order]
        text = io.StringIO()
        np.savetxt(text, table, delimiter=",", header="time," + ",".join(_NAMES), comments="")
        csv = _write_dump(text.getvalue().encode())
        samples = f"the last {kept} samples " + (f"are in {csv}" if csv else "could not be written")
        said = f"{where}{name} is {value} at t = {time:g} s"
        raise FloatingPointError(f"{said}; {samples}; reset() starts afresh")


def _write_dump(content: bytes) -> Path | None:
    """Write a file, and remove the oldest beyond `FILES`; None if it cannot be written."""
    chosen = os.environ.get(VARIABLE)
    folder = Path(chosen) if chosen else own_temporary_folder("slipgym_dumps")
    if folder is None:
        return None
    path = folder / f"not-finite-{uuid.uuid4().hex}.csv"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        atomic_io.write(path, content)
        files = sorted(folder.glob("not-finite-*.csv"), key=lambda each: each.stat().st_mtime_ns)
        for old in files[:-FILES]:
            old.unlink(missing_ok=True)
    except OSError:
        return path if path.is_file() else None
    return path
