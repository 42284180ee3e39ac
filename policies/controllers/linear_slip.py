"""Linear slip along gravity by grip force alone."""

from __future__ import annotations

import numpy as np

from policies.controllers.base import Columns, ForcePolicy, State
from policies.controllers.sensing import Caution, both, tangential
from slipgym.config import Overrides


class LinearSlipPolicy(ForcePolicy):
    """Slip controller of the gripper's paper (arXiv 2410.19660) on the friction it is told.

    The force that balances the load at Coulomb friction, f_slip, is filtered from the
    tangential force; the integral of the velocity error moves the grip around it:

        v_cmd = v_d + k_x (x_d - x),     e' = v_cmd - v,
        f = f_slip - k_e e + k_a f_slip a_d + k_v f_slip (v - v_cmd).

    Stick-slip moves the object in leaps of about 2 mm. When the reference rests and less than
    half a leap is left, another one would only overshoot, so the object is then held.

    Args:
        k_x: Position gain [1/s].
        k_e: Integral gain [N/m].
        k_a: Feed-forward of the reference acceleration [s^2/m].
        k_v: Velocity gain, as a share of f_slip [s/m].
        stop_band: Distance left at the reference's end that is not worth another slip [m].
        hold_margin: Grip there, as a multiple of what the load needs at Coulomb friction [-].
        smoothing: Share of the old f_slip kept per sample, in [0, 1).
        caution: Friction assumed until the estimate has support.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "LinearSlip"

    def __init__(
        self,
        k_x: float = 2.0,
        k_e: float = 1000.0,
        k_a: float = 0.1,
        k_v: float = 50.0,
        stop_band: float = 0.001,
        hold_margin: float = 1.3,
        smoothing: float = 0.95,
        caution: Caution | None = None,
        config: Overrides | None = None,
    ) -> None:
        super().__init__(config)
        if not 0.0 <= smoothing < 1.0:
            raise ValueError(f"smoothing = {smoothing!r} must lie in [0, 1)")
        self.k_x, self.k_e, self.k_a, self.k_v = k_x, k_e, k_a, k_v
        self.stop_band, self.hold_margin = stop_band, hold_margin
        self.smoothing = smoothing
        self.caution = caution or Caution()
        self._dt = 1.0 / self.config.physics.control_rate

    def initial_state(self, n: int) -> np.ndarray:
        """Integral e [m] and f_slip [N]; a negative f_slip has no sample yet. Shape (n, 2)."""
        return np.tile([0.0, -1.0], (n, 1))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        error, f_slip = np.asarray(state).T
        x, v = -columns["measured_slip_y"], -both(columns, "v_y")
        acceleration = columns["reference_acceleration"]
        balance = tangential(columns) / self.caution.blend(columns, "mu_c")
        kept = np.where(acceleration < 0.1, self.smoothing, 1.0)
        f_slip = np.where(f_slip < 0.0, balance, kept * f_slip + (1.0 - kept) * balance)
        v_cmd = columns["reference_velocity"] + self.k_x * (columns["reference_position"] - x)
        distance = columns["distance"]
        arrived = (columns["reference_position"] >= distance) & (x >= distance - self.stop_band)
        error = np.where(arrived, error, error + (v_cmd - v) * self._dt)
        force = f_slip * (1.0 + self.k_a * acceleration + self.k_v * (v - v_cmd)) - self.k_e * error
        force = np.where(arrived, np.maximum(force, self.hold_margin * balance), force)
        return force, np.column_stack((error, f_slip))
