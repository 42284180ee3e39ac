"""Measures what an update of each estimator costs, beside yardsticks in the same run."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import pandas as pd

import estimator
from lab.leaderboard.yardsticks import FilterpyUkf, NumpyRls

WRENCH = (1.2, 0.3, 5.0, 0.012)  # [N, N, N, N m]
TWIST = (0.015, 0.002, 1.2)  # [m/s, m/s, rad/s]
RATE = 120.0  # [Hz]


def costs(fingers: int = 4096, calls: int = 200, rounds: int = 10) -> pd.DataFrame:
    """Processor time of an update that learns mu_c and r, the best of some rounds.

    Args:
        fingers: In a batch.
        calls: Updates in a round, from Python; a round of a batch has a fifth.
        rounds: How often.

    Returns:
        `estimator`, `python_us`: one finger from Python [us], `batch_ns`: a finger of a batch [ns]; NaN for
        the yardsticks, which have none.
    """
    rows = []
    for name in estimator.names():
        alone, batch = estimator.make(name), estimator.make_batch(name, fingers)
        wrenches, twists = np.tile(WRENCH, (fingers, 1)), np.tile(TWIST, (fingers, 1))
        python = best(lambda t, one=alone: one.update(t, WRENCH, TWIST), calls, rounds)
        together = best(lambda t, all=batch, w=wrenches, v=twists: all.update(t, w, v), calls // 5, rounds)
        rows.append((name, 1e6 * python, 1e9 * together / fingers))
    wrench, twist = np.array(WRENCH), np.array(TWIST)
    for label, yardstick in (("numpy RLS", NumpyRls()), ("filterpy UKF", FilterpyUkf())):
        python = best(lambda t, one=yardstick: one.update(t, wrench, twist), calls, rounds)
        rows.append((label, 1e6 * python, np.nan))
    return pd.DataFrame(rows, columns=["estimator", "python_us", "batch_ns"])


def best(update: Callable[[float], object], calls: int, rounds: int) -> float:
    """Least processor time of a call, over rounds [s]; one round to warm up goes before."""
    least, k = np.inf, 0
    for i in range(rounds + 1):
        start = time.process_time()
        for _ in range(calls):
            k += 1
            update(k / RATE)
        if i > 0:
            least = min(least, (time.process_time() - start) / calls)
    return least
