"""Decides what a motion has shown of friction at a time: no estimator can know more."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lab.worlds.scenario import Scenario
from lab.worlds.trace import Trace

FAST, LOADED = 0.004, 0.4
"""Scaled slip speed [m/s] and normal force [N] from which on a sample counts."""
PURE, SPIN = 0.97, 0.2
"""gamma_t above which a slip shows no r, below which it is a spin [-]."""
SLIDES = 0.4
"""gamma_t from which on it shows mu [-]."""
ENOUGH, OF_LEAPS = 0.25, 0.125
"""Time of slip that shows a quantity; mu in leaps, which are short [s]."""


class Mark(NamedTuple):
    """A time at which estimates are evaluated, and the truth there."""

    sample: int
    """Number of the sample."""
    mu_c: float
    """[-]"""
    mu_s: float
    """[-]"""
    r: float
    """[m]"""
    shows_mu: bool
    """Whether the motion since friction last changed has shown mu."""
    shows_r: bool
    """Whether it has shown r."""

    def shows(self, quantity: str) -> bool:
        """Whether it has shown mu_c, mu_s or r."""
        return self.shows_r if quantity == "r" else self.shows_mu


def marks(scenario: Scenario, trace: Trace, steps: NDArray[np.int64]) -> list[Mark]:
    """The marks of a record.

    Args:
        scenario: The scenario.
        trace: What truly happens.
        steps: Steps at whose ends samples are taken, (m,).
    """
    t = (steps + 1) / trace.rate
    mu_c, mu_s, r = trace.truth[steps].T
    slip = trace.slip[steps]
    v_t, rim = np.hypot(slip[:, 0], slip[:, 1]), r * np.abs(slip[:, 2])
    speed = np.hypot(v_t, rim)
    gamma_t = v_t / np.maximum(speed, 1e-12)
    counts = (speed > FAST) & (trace.normal[steps] > LOADED)
    time = np.diff(t, prepend=0.0)
    found = []
    for at in trace.marks:
        k = int(np.searchsorted(t, at)) - 1
        after = t > trace.jump
        same = after == after[k] if scenario.contact.changes else np.ones(len(t), bool)
        use = counts & same & (np.arange(len(t)) <= k)
        slides, both, spins = (
            float(time[use & kind].sum())
            for kind in (gamma_t > SLIDES, (gamma_t > SPIN) & (gamma_t < PURE), gamma_t <= PURE)
        )
        enough = OF_LEAPS if scenario.motion == "leaps" else ENOUGH
        shows_r = both >= ENOUGH or (slides >= ENOUGH and spins >= ENOUGH)
        found.append(Mark(k, mu_c[k], mu_s[k], r[k], slides >= enough or both >= ENOUGH, shows_r))
    return found
