"""Lifts and carries an object with a grip between slip and breakage."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from pydantic import Field

from policies.controllers.base import Columns
from policies.controllers.gains import Fraction
from policies.controllers.lifting import LiftingGains, LiftingPolicy
from slipgym.config.base import NonNegative, Positive


class FragileHoldGains(LiftingGains):
    """Gains of `FragileHoldPolicy`."""

    confidence: Positive = Field(default=0.01, description="Confidence from which mu_s is taken as it is [-]")
    deviations: NonNegative = Field(
        default=0.12, description="Standard deviations by which mu_s is taken below its estimate [-]"
    )
    place: Fraction = Field(
        default=0.45, description="Place of the grip between least and breaking force, logarithmic [-]"
    )


class FragileHoldPolicy(LiftingPolicy[FragileHoldGains]):
    """Grip between the least force that holds the object and the force that breaks it.

        f = allowance^place W (a / g) / mu_s

    a is the largest acceleration of the plan; for W and friction see `LiftingPolicy`. Without friction in the
    observation mu_s stays at a guess, for which the middle of the range serves best.

    Args:
        gains: See `FragileHoldGains`; each is a keyword argument of its own, too.
        prior: As in the other controllers; here r alone is used.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "FragileHold"
    Gains = FragileHoldGains
    without_friction: ClassVar[Mapping[str, Any]] = {"guess": 0.5, "shown": 0.0}

    def share(self, columns: Columns) -> np.ndarray:
        """See `LiftingPolicy.share`."""
        peak = columns["peak_acceleration"] / self.config.physics.gravity
        return columns["allowance"] ** self.gains.place * peak
