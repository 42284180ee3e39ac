"""Ranks the motions by what twenty more seconds of each would show: Fisher information of its rollouts."""

from __future__ import annotations

import numpy as np

from slipgym.identification.fit import Result, slopes
from slipgym.identification.motions import MOTIONS
from slipgym.identification.parameters import DEVIATION, PARAMETERS

LENGTH = 20.0
"""Of a motion [s]."""


def gains(result: Result) -> list[tuple[str, float, str]]:
    """(motion, sum over the parameters of the relative fall of the deviation, what falls most), best first.

    The information of the log is scaled such that it gives the deviations found, which are wider than those
    of white noise; the new motion's is scaled by the same factor.
    """
    present = ~np.isnan(result.noise)
    noise = result.noise / np.sqrt(np.isfinite(result.log.readings).mean(axis=0))  # of rows, some without
    before = np.sqrt(np.diag(np.linalg.inv(result.information)))
    widened = np.median((result.deviation / before)[result.shown]) if result.shown.any() else 1.0
    prior = np.diag(DEVIATION**-2.0)
    data = (result.information - prior) / widened**2
    before = np.sqrt(np.diag(np.linalg.inv(data + prior)))
    rate, ranked = result.log.rate, []
    for name, motion in MOTIONS.items():
        of = slopes(result.point, result.contact, rate, *motion(np.arange(round(LENGTH * rate)) / rate))
        of = (of[:, :, present] / noise[present] / widened).reshape(len(of), -1)
        after = np.sqrt(np.diag(np.linalg.inv(data + prior + of @ of.T)))
        fall = 1.0 - after / before
        ranked.append((name, float(fall.sum()), PARAMETERS[int(np.argmax(fall))].name))
    return sorted(ranked, key=lambda each: -each[1])
