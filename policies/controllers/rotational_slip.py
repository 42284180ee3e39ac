"""Turns the object about the grip axis by gravity and grip force alone."""

from __future__ import annotations

import numpy as np

from policies.controllers.base import Columns, State
from policies.controllers.gains import Fraction, Gain, GainPolicy
from policies.controllers.sensing import ConservativePrior, both, relative
from policies.controllers.slip_memory import SlipGains, SlipState, combined, remembered, weight_of
from slipgym.config import Overrides
from slipgym.config.base import NonNegative, Positive

_FIRST = 0.02  # confidence of one update


class RotationalSlipGains(SlipGains):
    """Gains of `RotationalSlipPolicy`."""

    k_x: NonNegative = Gain(3.0, "Gain on the angle [1/s]")
    k_v: NonNegative = Gain(0.5, "Gain on the rate while turning, over f_slip [s/rad]")
    k_e: NonNegative = Gain(33.0, "Gain on the integral, over f_slip [1/rad]")
    k_m: NonNegative = Gain(0.15, "Rate of the integral while turning, over that while sticking [-]")
    moving: NonNegative = Gain(0.03, "Rate from which the object counts as turning [rad/s]")
    stop_band: NonNegative = Gain(0.005, "Angle left at the end that is not worth another slip [rad]")
    hold_margin: Positive = Gain(1.3, "Grip before and after the turn, over f_slip [-]")
    smoothing: Fraction = Gain(0.98, "Weight of the old torque in each control step [-]")
    shown: NonNegative = Gain(0.02, "Deviation of torque over force in a slip, 0: it does not count [-]")


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
    last slip counts too, each with the weight of its variance (`slip_memory.weight_of`): a friction that
    jumps shows there first. The feedback forgives an error, so an uncertain estimate already replaces the
    prior.

    Arguments are those of `GainPolicy`. Its own prior counts until the first update of the estimate, and
    without `shown` it is `ConservativePrior()`.
    """

    task = "RotationalSlip"
    Gains = RotationalSlipGains

    def _prepare(self, config: Overrides | None) -> None:
        if self.gains.shown > 0.0 and self.prior is self.prior_default:
            self.prior = ConservativePrior(confidence=_FIRST)

    def initial_state(self, n: int) -> np.ndarray:
        """Integral e [rad], filtered torque [N m] (< 0: no sample yet), 1 if turning, `SlipState`, (n, 5)."""
        return np.tile([0.0, -1.0, 0.0, 0.0, 0.0], (n, 1))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        g = self.gains
        error, torque, turned, *past = np.asarray(state).T
        angle, omega = -columns["measured_slip_theta"], -both(columns, "omega")
        tau = np.abs(both(columns, "tau"))
        torque = np.where(torque < 0.0, tau, g.smoothing * torque + (1.0 - g.smoothing) * tau)
        lever, cautious = self.prior.blend_lever(columns), self.prior.hold_lever(columns)
        slip = remembered(columns, SlipState(*past), self.prior.r, g)
        shown = slip.mu_c * self.prior.r * (g.shown > 0.0)
        deviation = relative(columns, "lever", columns["mu_c"] * columns["r"])
        weight = weight_of(shown, deviation * (columns["confidence_mu_c"] > 0.0), g.shown)
        lever, cautious = combined(lever, shown, weight), combined(cautious, shown, weight)
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
        return f_slip * share, np.column_stack((error, torque, turning, *slip))
