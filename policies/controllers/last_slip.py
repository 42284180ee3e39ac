"""Load over normal force in the last slip: a memory of friction from sensors alone."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from pydantic import Field

from policies.controllers.base import Columns
from policies.controllers.sensing import both, scaled_load, scaled_speed
from slipgym.config.base import Frozen, NonNegative, Positive


class SlipGains(Frozen):
    """Gains of noticing a slip."""

    speed: Positive = Field(default=0.003, description="Scaled slip speed that is a slip [m/s]")
    rest: NonNegative = Field(default=12, description="Control steps after a slip without another one [-]")


class SlipState(NamedTuple):
    """Memory of the slips, (n,) each; all 0 at the start."""

    mu_c: np.ndarray
    """Load over normal force in the last slip; 0 before the first [-]."""
    rest: np.ndarray
    """Control steps left without another slip."""


def remembered(columns: Columns, past: SlipState, r: np.ndarray | float, gains: SlipGains) -> SlipState:
    """The memory after the present observation.

    Args:
        columns: n observations.
        past: The memory before.
        r: Contact radius that scales torque and rate, (n,) or one for all [m]. In a turn without a slide
            `mu_c` times r is the torque per normal force, whatever r is.
        gains: When a slip is noticed.
    """
    slips = (scaled_speed(columns, r) > gains.speed) & (past.rest <= 0.0)
    shown = scaled_load(columns, r) / np.maximum(both(columns, "f_n"), 1e-3)
    return SlipState(
        mu_c=np.where(slips, shown, past.mu_c), rest=np.where(slips, gains.rest, past.rest - 1.0)
    )


def weight_of(shown: np.ndarray, deviation: np.ndarray, own: float) -> np.ndarray:
    """Weight of what the last slip showed against an estimate: that of the least variance, (n,) in [0, 1].

    Args:
        shown: What the last slip showed, (n,); 0 before the first.
        deviation: Relative standard deviation of the estimate, (n,) [-]; 0 for friction that is known.
        own: That of what a slip shows [-].
    """
    square = deviation**2
    return np.where(shown > 0.0, square / (square + own**2), 0.0)


def combined(estimate: np.ndarray, shown: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Weighted geometric mean of an estimate and what the last slip showed, (n,)."""
    return np.where(weight > 0.0, estimate ** (1.0 - weight) * np.maximum(shown, 1e-12) ** weight, estimate)
