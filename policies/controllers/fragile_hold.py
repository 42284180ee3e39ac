"""Lifts and carries an object with a grip between slip and breakage."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from policies.controllers.base import Columns
from policies.controllers.gains import Fraction, Gain
from policies.controllers.lifting import LiftingGains, LiftingPolicy
from slipgym.config.base import NonNegative, Positive


class FragileHoldGains(LiftingGains):
    """Gains of `FragileHoldPolicy`."""

    confidence: Positive = Gain(0.01, "Confidence from which mu_s is taken as it is [-]")
    deviations: NonNegative = Gain(0.12, "Standard deviations by which mu_s is taken below its estimate [-]")
    noise: NonNegative = Gain(0.05, "Fall of the load that is always noise [N]")
    place: Fraction = Gain(0.45, "Place of the grip between least and breaking force, logarithmic [-]")


class FragileHoldPolicy(LiftingPolicy[FragileHoldGains]):
    """Grip between the least force that holds the object and the force that breaks it.

        f = allowance^place W (a / g) / mu_s

    a is the largest acceleration of the plan; for W and friction see `LiftingPolicy`. Without friction in the
    observation mu_s stays at a guess, for which the middle of the range serves best.

    Arguments are those of `GainPolicy`; of the prior r alone is used.
    """

    task = "FragileHold"
    Gains = FragileHoldGains
    without_friction: ClassVar[Mapping[str, Any]] = {"guess": 0.5, "shown": 0.0}

    def share(self, columns: Columns) -> np.ndarray:
        """See `LiftingPolicy.share`."""
        peak = columns["peak_acceleration"] / self.config.physics.gravity
        return columns["allowance"] ** self.gains.place * peak
