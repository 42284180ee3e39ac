"""Turning the object about the grip axis by gravity and grip force alone."""

from __future__ import annotations

import numpy as np

from policies.controllers.base import Columns, ForcePolicy, State
from policies.controllers.sensing import Caution, both
from slipgym.config import Overrides


class RotationalSlipPolicy(ForcePolicy):
    """Let the object turn with the reference, on the friction it is told.

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

    Only the product mu_c r is used. In almost pure rotation it is what torque and force tell; mu_c and r
    on their own are not.

    Args:
        k_x: Gain on the angle [1/s].
        k_v: Gain on the rate while turning, as a share of f_slip [s/rad].
        k_e: Gain on the integral, as a share of f_slip [1/rad].
        k_m: How much slower the integral grows while turning [-].
        moving: Rate from which the object counts as turning [rad/s].
        stop_band: Angle left at the reference's end that is not worth another slip [rad].
        hold_margin: Grip before and after the turn, as a multiple of f_slip [-].
        smoothing: Share of the old torque kept per sample, in [0, 1).
        caution: Friction assumed until the estimate has support.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "RotationalSlip"

    def __init__(
        self,
        k_x: float = 3.0,
        k_v: float = 0.5,
        k_e: float = 33.0,
        k_m: float = 0.15,
        moving: float = 0.03,
        stop_band: float = 0.005,
        hold_margin: float = 1.3,
        smoothing: float = 0.98,
        caution: Caution | None = None,
        config: Overrides | None = None,
    ) -> None:
        super().__init__(config)
        if not 0.0 <= smoothing < 1.0:
            raise ValueError(f"smoothing = {smoothing!r} must lie in [0, 1)")
        self.k_x, self.k_v, self.k_e, self.k_m = k_x, k_v, k_e, k_m
        self.moving, self.stop_band, self.hold_margin = moving, stop_band, hold_margin
        self.smoothing = smoothing
        self.caution = caution or Caution()
        self._dt = 1.0 / self.config.physics.control_rate

    def initial_state(self, n: int) -> np.ndarray:
        """Integral e [rad], filtered torque [N m] (negative: no sample yet), 1 if turning. Shape (n, 3)."""
        return np.tile([0.0, -1.0, 0.0], (n, 1))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        error, torque, turned = np.asarray(state).T
        angle, omega, tau = (
            -columns["measured_slip_theta"],
            -both(columns, "omega"),
            np.abs(both(columns, "tau")),
        )
        torque = np.where(torque < 0.0, tau, self.smoothing * torque + (1.0 - self.smoothing) * tau)
        f_slip = torque / self.caution.blend_lever(columns)
        reference, goal = columns["reference_position"], columns["angle"]
        ahead = columns["reference_velocity"] + self.k_x * (reference - angle) - omega
        turning = omega > self.moving
        arrived = (reference >= goal) & (angle >= goal - self.stop_band)
        still = arrived | (reference <= 0.0)
        error = np.where(turning & (turned == 0.0), 0.0, error)
        error = np.where(still, 0.0, error + np.where(turning, self.k_m, 1.0) * ahead * self._dt)
        share = 1.0 - self.k_e * error - np.where(turning, self.k_v * ahead, 0.0)
        share = np.where(still, np.maximum(share, self.hold_margin), share)
        return f_slip * share, np.column_stack((error, torque, turning))
