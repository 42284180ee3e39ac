"""Notices the first number that is not finite, and keeps what led to it."""

from __future__ import annotations

import math
import os
import tempfile
from pathlib import Path
from typing import NoReturn

import numpy as np

from slipgym._numba.compiled import compiled

KEPT = 120
"""Samples whose quantities are kept: the last second."""

_FINGERS = ("normal_force", "grip_force", "friction_x", "friction_y", "friction_tau", "mu_s", "mu_c", "r")
_SENSORS = ("f_x", "f_y", "f_n", "tau", "v_x", "v_y", "omega")
QUANTITIES = (
    *(f"object_{name}" for name in ("x", "z", "angle", "v_x", "v_z", "omega")),
    *(f"wrist_{name}" for name in ("x", "z", "pitch")),
    *(f"disturbance_{name}" for name in ("x", "z", "torque")),
    *(f"{name}_{f}" for f in (1, 2) for name in _FINGERS[:5]),
    *(f"measured_{name}_{f}" for f in (1, 2) for name in _SENSORS),
    *(f"estimated_{name}_{f}" for f in (1, 2) for name in _FINGERS[5:]),
    "reward",
)
"""What is watched, in SI units, in the order in which one follows from the other."""


@compiled
def note(row, i, worlds, pads, fingers, wrenches, twists, per_finger, episodes):
    """Write the quantities of world i.

    Args:
        row: Output (len(QUANTITIES),).
        i: Which of the n worlds.
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
    world = worlds[i]
    row[0], row[1], row[2] = world.com[0], world.com[1], world.angle
    for a in range(3):
        row[3 + a], row[6 + a], row[9 + a] = world.velocity[a], world.wrist[a], world.external[a]
    k = 12
    for f in range(2):
        row[k], row[k + 1] = pads[i, f].normal, fingers[i, f].force
        for a in range(3):
            row[k + 2 + a] = pads[i, f].wrench[a]
        k += 5
    for f in range(2):
        for a in range(4):
            row[k + a] = wrenches[i, f, a]
        for a in range(3):
            row[k + 4 + a] = twists[i, f, a]
        k += 7
    for f in range(2):
        for a in range(3):
            row[k + a] = per_finger[i, f, a]
        k += 3
    row[k] = episodes[i].terms.sum()
    for j in range(k + 1):
        if not math.isfinite(row[j]):
            return j
    return -1


@compiled
def sound(i, worlds, pads, fingers, per_finger, episodes):
    """Whether what `note` writes of world i is finite but for the measurements, which only pass it on."""
    world = worlds[i]
    total = world.com[0] + world.com[1] + world.angle + episodes[i].terms.sum()
    for a in range(3):
        total += world.velocity[a] + world.wrist[a] + world.external[a]
        for f in range(2):
            total += pads[i, f].wrench[a] + per_finger[i, f, a]
    for f in range(2):
        total += pads[i, f].normal + fingers[i, f].force
    return math.isfinite(total)


class Guard:
    """Keeps the last samples' quantities; stops a simulation in which one is not finite."""

    def __init__(self) -> None:
        self._rows = np.zeros((KEPT, len(QUANTITIES)))
        self._times = np.zeros(KEPT)
        self._count = 0

    def reset(self) -> None:
        """Forget the last episode."""
        self._count = 0

    def watch(self, time: float, i: int, *arrays: np.ndarray) -> None:
        """Take a sample's quantities.

        Args:
            time: [s].
            i: Which of the worlds.
            *arrays: Of the worlds, in the order of `note`.

        Raises:
            FloatingPointError: One is not finite. The message names the first and the file that the kept
                samples were written to.
        """
        at = self._count % KEPT
        self._count += 1
        self._times[at] = time
        bad = note(self._rows[at], i, *arrays)
        if bad >= 0:
            self._stop(QUANTITIES[bad], self._rows[at, bad], time)

    def _stop(self, name: str, value: float, time: float) -> NoReturn:
        kept = min(self._count, KEPT)
        order = np.arange(self._count - kept, self._count) % KEPT
        table = np.column_stack([self._times[order], self._rows[order]])
        handle, path = tempfile.mkstemp(prefix="slipgym-", suffix=".part")
        with os.fdopen(handle, "w") as file:
            np.savetxt(file, table, delimiter=",", header="time," + ",".join(QUANTITIES), comments="")
        csv = Path(path).replace(Path(path).with_suffix(".csv"))
        raise FloatingPointError(
            f"{name} is {value} at t = {time:g} s; the last {kept} samples are in {csv}; "
            "reset() starts afresh"
        )
