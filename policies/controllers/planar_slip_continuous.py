"""Brings the object to a pose (x, y, theta) in the grip in slips of a regulated speed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from policies.controllers.base import Columns
from policies.controllers.gains import Fraction, Gain
from policies.controllers.planar_plan import (
    Motion,
    Pair,
    PlanarPlanPolicy,
    PlanGains,
    PlanState,
)
from policies.controllers.sensing import scaled_load
from slipgym.config.base import NonNegative


class SlipState(NamedTuple):
    """Memory of the slips, (n,) each; all 0 at the start."""

    moving: np.ndarray  # 1 while it moves
    error: np.ndarray  # integral of the missing speed [m or rad]
    broken: np.ndarray  # the integral at the last break-away [m or rad]
    leaps: np.ndarray  # break-aways in this slip so far


class ContinuousPlanarSlipGains(PlanGains):
    """Gains of `ContinuousPlanarSlipPolicy`; pairs are of slide and turn."""

    speeds: Pair = Gain((0.006, 0.2), "Largest speed of a slide [m/s] and rate of a turn [rad/s]")
    gain: NonNegative = Gain(2.0, "Speed wanted per distance left, down to a quarter of the largest [1/s]")
    k_e: Pair = Gain((150.0, 10.0), "Gains on the integral, over f_slip [1/m, 1/rad]")
    k_v: Pair = Gain((50.0, 0.5), "Gains on the speed, over f_slip [s/m, s/rad]")
    k_m: NonNegative = Gain(0.15, "Rate of the integral while moving, over that while sticking [-]")
    keep: Fraction = Gain(0.6, "Fraction of the integral at a break-away with which the next is sought [-]")
    leaps: int = Gain(8, "Break-aways after which a slip is braked less [-]", ge=0)


class ContinuousPlanarSlipPolicy(PlanarPlanPolicy[ContinuousPlanarSlipGains]):
    """The plan of `PlanarPlanPolicy` in slips of a regulated speed.

    It needs a slip velocity that is at most one or two samples old; "planar_slip" does not.

    A slip is let go by what balances the load at Coulomb friction, f_slip, as in "rotational_slip": v is the
    speed of the slide or the rate of the turn, v_cmd the one wanted,

        sticking:  e' = v_cmd - v,           f = f_slip (1 - k_e e)
        moving:    e' = k_m (v_cmd - v),     f = f_slip (1 - k_e e + k_v (v - v_cmd))

    e begins at 0 at a break-away. When the object sticks again, it begins at a fraction of its value there.
    After `leaps` break-aways in a slip, which then must be small ones, e keeps more at each. A slip that
    static friction has held back leaps; what is less than half a leap is left as it is.
    """

    Gains = ContinuousPlanarSlipGains
    Slips = SlipState

    def initial_state(self, n: int) -> np.ndarray:
        """Columns of `PlanState` and `SlipState`, (n, 13)."""
        return np.zeros((n, len(PlanState._fields) + len(SlipState._fields)))

    def creep(self, left: np.ndarray, r: np.ndarray) -> np.ndarray:
        """That of steady slip on the limit surface."""
        return left * r**2

    def slip(
        self, columns: Columns, slips: SlipState, motion: Motion, begins: np.ndarray, r: np.ndarray
    ) -> tuple[np.ndarray, SlipState]:
        """See `PlanarPlanPolicy.slip`."""
        k_e, k_v, top = (
            np.where(motion.turning, b, a) for a, b in (self.gains.k_e, self.gains.k_v, self.gains.speeds)
        )
        load = scaled_load(columns, r) / self.prior.blend(columns, "mu_c")
        ahead = np.clip(self.gains.gain * motion.distance, 0.25 * top, top) - motion.speed
        moving, moved = motion.speed > 0.15 * top, slips.moving > 0.0
        breaks, sticks = moving & ~moved, moved & ~moving
        leaps = np.where(motion.wanted, slips.leaps + breaks, 0.0)
        broken = np.where(breaks, slips.error, slips.broken)
        left_over = np.clip(0.05 * (leaps - self.gains.leaps), 0.0, self.gains.keep) * broken
        error = np.where(breaks, left_over, np.where(sticks, self.gains.keep * broken, slips.error))
        error = np.where(motion.wanted, error + np.where(moving, self.gains.k_m, 1.0) * ahead * self._dt, 0.0)
        share = 1.0 - k_e * error - np.where(moving, k_v * ahead, 0.0)
        force = np.where(motion.wanted, np.minimum(load * share, motion.held), motion.held)
        return force, SlipState(moving, error, broken, leaps)
