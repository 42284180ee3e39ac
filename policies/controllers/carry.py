"""Swings an object with a grip that follows the planned load."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from policies.controllers.base import Columns
from policies.controllers.gains import Gain
from policies.controllers.lifting import LiftingGains, LiftingPolicy
from slipgym.config.base import NonNegative, Positive
from slipgym.tasks.carry import AHEAD

_NEAR = tuple(f"{1e3 * time:.0f}" for time in AHEAD if time <= 0.1)


class CarryGains(LiftingGains):
    """Gains of `CarryPolicy`."""

    margin: Positive = Gain(1.15, "Grip over the least for the planned load [-]")
    lightest: NonNegative = Gain(0.7, "Least load per finger that a grip is made for [N]")
    catch: Positive = Gain(1.8, "Least factor by which the grip rises after a slip [-]")
    kick: Positive = Gain(3.0, "Command in the control step of a catch, over the grip wanted [-]")
    deviations: NonNegative = Gain(0.3, "Standard deviations by which mu_s is taken below its estimate [-]")


class CarryPolicy(LiftingPolicy[CarryGains]):
    """Grip as hard as the planned motion needs, with a margin.

        f = margin W (a / g) / mu_s

    a is the largest acceleration less gravity that the plan has from now to 100 ms ahead: the force follows a
    command within about 30 ms, and acceleration changes between the times at which it is observed. For W and
    friction see `LiftingPolicy`. Without friction in the observation mu_s stays at a guess.

    Arguments are those of `GainPolicy`; of the prior r alone is used.
    """

    task = "Carry"
    Gains = CarryGains
    without_friction: ClassVar[Mapping[str, Any]] = {"guess": 0.4, "shown": 0.0}

    def share(self, columns: Columns) -> np.ndarray:
        """See `LiftingPolicy.share`."""
        gravity, most = self.config.physics.gravity, np.zeros(len(columns))
        for ahead in _NEAR:
            x, z = (columns[f"planned_acceleration_{axis}_{ahead}"] for axis in "xz")
            most = np.maximum(most, np.hypot(x, z + gravity))
        return self.gains.margin * most / gravity
