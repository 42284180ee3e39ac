"""From recordings to what the network reads: the columns of the samples in contact, and the truth there."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from estimator._numba.caching import njit
from lab.learned_estimator.episodes import READINGS, Recording
from lab.learned_estimator.features import COLUMNS, sense
from lab.learned_estimator.gru import GruParameters, initial_states

RATE = 120.0
"""Samples per second."""


@dataclass(frozen=True)
class Sequence:
    """Samples of a finger in contact."""

    columns: np.ndarray
    """Columns of the network, (n, COLUMNS)."""
    targets: np.ndarray
    """ln mu_s, ln mu_c, ln r [m], (n, 3)."""


@njit(error_model="numpy")
def _walk(states, parameters, readings, elapsed, columns, touches):
    """Columns (n, COLUMNS) of readings (n, 7), and whether the finger is in contact (n,)."""
    for k in range(readings.shape[0]):
        row = readings[k]
        wrench = float(row[0]), float(row[1]), float(row[2]), float(row[3])
        twist = float(row[4]), float(row[5]), float(row[6])
        found = sense(states[0], parameters[0], wrench, twist, elapsed, columns[k])
        touches[k] = found[0]
        states[0].f_n = found[2]
        states[0].samples += 1


def sequences(recordings: Iterable[Recording], unzeroed: float, seed: int) -> list[Sequence]:
    """Columns and targets of recordings, by the compiled function of the estimator.

    Args:
        recordings: Recordings.
        unzeroed: Fraction of them whose readings of the open gripper are left out [-].
        seed: Of the choice.
    """
    rng = np.random.default_rng(seed)
    parameters = GruParameters().as_array()
    found = []
    for one in recordings:
        first = READINGS if rng.random() < unzeroed else 0
        readings, truth = one.readings[first:], one.truth[first:]
        columns = np.zeros((len(readings), COLUMNS), np.float32)
        touches = np.zeros(len(readings), bool)
        _walk(initial_states(parameters), parameters, readings, 1.0 / RATE, columns, touches)
        used = touches & np.isfinite(truth).all(axis=1)
        if used.any():
            found.append(Sequence(columns[used], np.log(truth[used])))
    return found
