"""Brings the object to a pose (x, y, theta) in the grip by gravity, wrist and grip force."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import Field

from policies.controllers import leaps
from policies.controllers.base import Columns
from policies.controllers.leaps import LeapGains, LeapState, Slip
from policies.controllers.planar_plan import Motion, Pair, PlanarPlanPolicy, PlanGains, PlanState
from policies.controllers.sensing import ConservativePrior, scaled_load, scaled_speed
from slipgym.config import Overrides
from slipgym.config.base import NonNegative


class PlanarSlipGains(PlanGains, LeapGains):
    """Gains of `PlanarSlipPolicy`, those of the leaps among them; pairs are of slide and turn."""

    least: Pair = Field(
        default=(0.0009, 0.02), description="Least slide [m] and turn [rad] to begin; it stops at half"
    )
    creep: NonNegative = Field(
        default=4.8e-5,
        description="Creep of the pads per radian of a turn, times the lever of the centre of mass [m^2]",
    )


class PlanarSlipPolicy(PlanarPlanPolicy[PlanarSlipGains]):
    """The plan of `PlanarPlanPolicy` in leaps that the force begins and ends (`policies.controllers.leaps`).

    A leap needs no prompt velocity, so the slip sensor may be late by an unknown number of samples; after
    each leap the object rests until the sensor has shown it. Friction of the observation sets the grip that
    holds and the one from which the first break-away is looked for; then the last break-away counts.

    The creep of a turn is larger in leaps than r^2 per radian over |b|, as in steady slip; `creep` is the
    mean of what was found in simulation with contact radii of 4 to 5 mm.

    Args:
        gains: See `PlanarSlipGains`; each is a keyword argument of its own, too.
        prior: Friction assumed until the estimate has confidence.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    Gains = PlanarSlipGains
    Slips = LeapState

    def __init__(
        self,
        gains: PlanarSlipGains | None = None,
        prior: ConservativePrior | None = None,
        config: Overrides | None = None,
        **parameters: Any,
    ) -> None:
        super().__init__(gains, prior, config, **parameters)
        self._leaps = leaps.at_rate(self.gains, self.config.physics.control_rate)

    def initial_state(self, n: int) -> np.ndarray:
        """Columns of `PlanState` and `LeapState`, (n, 18)."""
        plan = np.zeros((n, len(PlanState._fields)))
        return np.column_stack((plan, *leaps.begin(n, self._leaps)))

    def creep(self, left: np.ndarray, r: np.ndarray) -> np.ndarray:
        """See `PlanarPlanPolicy.creep`."""
        return self.gains.creep * left

    def interruptible(self, slips: LeapState) -> np.ndarray:
        """Between leaps, once they have been measured."""
        return slips.clock == 0.0

    def slip(
        self, columns: Columns, slips: LeapState, motion: Motion, begins: np.ndarray, r: np.ndarray
    ) -> tuple[np.ndarray, LeapState]:
        """See `PlanarPlanPolicy.slip`."""
        asked = Slip(
            wanted=motion.wanted,
            begins=begins,
            turning=motion.turning,
            distance=motion.distance,
            load=scaled_load(columns, r),
            speed=scaled_speed(columns, r),
            f_slip=1.0 / self.prior.blend(columns, "mu_c"),
            held=motion.held,
        )
        return leaps.leap(slips, asked, self._leaps, self.config.gripper.force_max)
