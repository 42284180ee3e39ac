"""Turns the object about the grip axis by gravity and grip force alone."""

from __future__ import annotations

import numpy as np
from pydantic import Field

from policies.controllers.base import Columns, State
from policies.controllers.gains import Fraction, GainPolicy
from policies.controllers.last_slip import SlipGains, SlipState, combined, remembered, weight_of
from policies.controllers.sensing import ConservativePrior, both, relative
from slipgym.config import Overrides
from slipgym.config.base import NonNegative, Positive

_FIRST = 0.02  # confidence of one update


class RotationalSlipGains(SlipGains):
    """Gains of `RotationalSlipPolicy`."""

    k_x: NonNegative = Field(default=3.0, description="Gain on the angle [1/s]")
    k_v: NonNegative = Field(default=0.5, description="Gain on the rate while turning, over f_slip [s/rad]")
    k_e: NonNegative = Field(default=33.0, description="Gain on the integral, over f_slip [1/rad]")
    k_m: NonNegative = Field(
        default=0.15, description="Rate of the integral while turning, over that while sticking [-]"
    )
    moving: NonNegative = Field(
        default=0.03, description="Rate from which the object counts as turning [rad/s]"
    )
    stop_band: NonNegative = Field(
        default=0.005, description="Angle left at the end that is not worth another slip [rad]"
    )
    hold_margin: Positive = Field(default=1.3, description="Grip before and after the turn, over f_slip [-]")
    smoothing: Fraction = Field(default=0.98, description="Weight of the old torque in each control step [-]")
    shown: NonNegative = Field(
        default=0.02,
        description="Deviation of torque over force in a slip, 0: it does not count [-]",
    )


class RotationalSlipPolicy(GainPolicy[RotationalSlipGains]):
    """Let the object turn with the reference, with the friction of the observation.

    The force that balances gravity's torque at Coulomb friction is f_slip = tau / (mu_c r), with tau
    filtered. Static friction asks for less force to let go than Coulomb friction asks for to go on, so
    sticking and turning have a law each, with w the measured rate:

        w_cmd = w_d + k_x (theta_d - theta)
        sticking:  e' = w_cmd - w,           f = f_slip (1 - k_e e)
        turning:   e' = k_m (w_cmd - w),     f = f_slip (1 - k_e e + k_v (w - w_cmd))

    and e starts at 0 at every break-away, as it does while the reference rests. The gripper's public
    controller (arXiv 2410.19660) uses one law for both; its force then stays low after a break-away, and
    what it has to brake is a leap. k_v is bounded by the delays of sensor and force loop: torque per
    force over inertia, times k_v f_slip, times about 30 ms has to stay well below 1.

    Only the product mu_c r is used. In almost pure rotation it is what torque and force show; mu_c and r
    on their own are not. Where the observation states a deviation of the product, torque over force in the
    last slip counts too, each with the weight of its variance (`policies.controllers.last_slip`): a friction
    that jumps shows there first. The feedback forgives an error, so an uncertain estimate already replaces
    the prior.

    Args:
        gains: See `RotationalSlipGains`; each is a keyword argument of its own, too.
        prior: Friction assumed until the estimate has confidence; None: until its first update, and
            `ConservativePrior()` without `shown`.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "RotationalSlip"
    Gains = RotationalSlipGains

    def _prepare(self, config: Overrides | None) -> None:
        if self.gains.shown > 0.0 and self.prior is self.prior_default:
            self.prior = ConservativePrior(confidence=_FIRST)

    def initial_state(self, n: int) -> np.ndarray:
        """Integral e [rad], filtered torque [N m] (negative: no sample yet), 1 if turning, then `SlipState`.

        Without `shown` the last is left out. Shape (n, 5) or (n, 3).
        """
        width = len(SlipState._fields) if self.gains.shown > 0.0 else 0
        return np.tile([0.0, -1.0, 0.0, *(0.0 for _ in range(width))], (n, 1))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        g = self.gains
        error, torque, turned, *past = np.asarray(state).T
        angle, omega, tau = (
            -columns["measured_slip_theta"],
            -both(columns, "omega"),
            np.abs(both(columns, "tau")),
        )
        torque = np.where(torque < 0.0, tau, g.smoothing * torque + (1.0 - g.smoothing) * tau)
        lever, cautious = self.prior.blend_lever(columns), self.prior.hold_lever(columns)
        if past:
            slip = remembered(columns, SlipState(*past), self.prior.r, g)
            shown = slip.mu_c * self.prior.r
            weight = self._shown_weight(columns, shown)
            lever, cautious = combined(lever, shown, weight), combined(cautious, shown, weight)
            past = list(slip)
        f_slip = torque / lever
        reference, goal = columns["reference_position"], columns["angle"]
        ahead = columns["reference_velocity"] + g.k_x * (reference - angle) - omega
        turning = omega > g.moving
        arrived = (reference >= goal) & (angle >= goal - g.stop_band)
        still = arrived | (reference <= 0.0)
        error = np.where(turning & (turned == 0.0), 0.0, error)
        error = np.where(still, 0.0, error + np.where(turning, g.k_m, 1.0) * ahead * self._dt)
        share = 1.0 - g.k_e * error - np.where(turning, g.k_v * ahead, 0.0)
        share = np.where(still, np.maximum(share, g.hold_margin * lever / cautious), share)
        return f_slip * share, np.column_stack((error, torque, turning, *past))

    def _shown_weight(self, columns: Columns, shown: np.ndarray) -> np.ndarray:
        """Weight of the lever that the last slip showed, (n,); 0 without an estimate."""
        deviation = relative(columns, "lever", columns["mu_c"] * columns["r"])
        return weight_of(shown, deviation * (columns["confidence_mu_c"] > 0.0), self.gains.shown)
