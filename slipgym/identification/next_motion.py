"""Ranks the motions by what twenty more seconds of each would show: Fisher information of its rollouts."""

from __future__ import annotations

import numpy as np

from slipgym.identification.fit import STEP, Result
from slipgym.identification.motions import MOTIONS, session
from slipgym.identification.parameters import DEVIATION, PARAMETERS, values_of
from slipgym.identification.rollout import roll

LENGTH = 20.0
"""Of a motion [s]."""


def gains(result: Result) -> list[tuple[str, float, str]]:
    """(motion, sum over the parameters of the relative fall of the deviation, what falls most), best first.

    The information of the log is scaled such that it gives the deviations found, which are wider than those
    of white noise; the new motion's is scaled by the same factor.
    """
    information = result.information
    present = ~np.isnan(result.noise)
    before = np.sqrt(np.diag(np.linalg.inv(information)))
    widened = np.median((result.deviation / before)[result.shown]) if result.shown.any() else 1.0
    prior = np.diag(DEVIATION**-2.0)
    data = (information - prior) / widened**2
    before = np.sqrt(np.diag(np.linalg.inv(data + prior)))
    steps = np.diag(STEP * DEVIATION)
    points = np.concatenate([result.point + steps, result.point - steps])
    ranked = []
    for name in MOTIONS:
        command, motion = session(result.log.rate, LENGTH, (name,))
        readings = roll(values_of(points), result.log.rate, command, motion, result.contact)[:, :, present]
        half = len(result.point)
        slopes = (readings[:half] - readings[half:]) / (2.0 * STEP * DEVIATION)[:, None, None]
        slopes = (slopes / result.noise[present] / widened).reshape(half, -1)
        after = np.sqrt(np.diag(np.linalg.inv(data + prior + slopes @ slopes.T)))
        fall = 1.0 - after / before
        ranked.append((name, float(fall.sum()), PARAMETERS[int(np.argmax(fall))].name))
    return sorted(ranked, key=lambda each: -each[1])
