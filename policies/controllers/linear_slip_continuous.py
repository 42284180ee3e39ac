"""Controls linear slip along gravity by grip force alone, from the measured velocity."""

from __future__ import annotations

import numpy as np

from policies.controllers.base import Columns, State
from policies.controllers.gains import Fraction, Gain, GainPolicy
from policies.controllers.sensing import both, tangential
from slipgym.config.base import Frozen, NonNegative, Positive


class ContinuousLinearSlipGains(Frozen):
    """Gains of `ContinuousLinearSlipPolicy`."""

    k_x: NonNegative = Gain(2.0, "Position gain [1/s]")
    k_e: NonNegative = Gain(1000.0, "Integral gain [N/m]")
    k_a: NonNegative = Gain(0.1, "Feed-forward of the reference acceleration [s^2/m]")
    k_v: NonNegative = Gain(50.0, "Velocity gain over f_slip [s/m]")
    stop_band: NonNegative = Gain(0.001, "Distance left at the end that is not worth another slip [m]")
    hold_margin: Positive = Gain(1.3, "Grip there, over what the load needs at Coulomb friction [-]")
    smoothing: Fraction = Gain(0.95, "Weight of the old f_slip in each control step [-]")


class ContinuousLinearSlipPolicy(GainPolicy[ContinuousLinearSlipGains]):
    """Slip controller of the gripper's paper (arXiv 2410.19660) with the friction of the observation.

    The force that balances the load at Coulomb friction, f_slip, is filtered from the
    tangential force; the integral of the velocity error moves the grip around it:

        v_cmd = v_d + k_x (x_d - x),     e' = v_cmd - v,
        f = f_slip - k_e e + k_a f_slip a_d + k_v f_slip (v - v_cmd).

    Stick-slip moves the object in leaps of about 2 mm. When the reference rests and less than
    half a leap is left, another one would only overshoot, so the object is then held.

    The velocity has to arrive in time; where nobody knows that, "linear_slip" watches it.
    """

    task = "LinearSlip"
    Gains = ContinuousLinearSlipGains

    def initial_state(self, n: int) -> np.ndarray:
        """Integral e [m] and f_slip [N]; a negative f_slip has no sample yet. Shape (n, 2)."""
        return np.tile([0.0, -1.0], (n, 1))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        g = self.gains
        error, f_slip = np.asarray(state).T
        x, v = -columns["measured_slip_y"], -both(columns, "v_y")
        acceleration = columns["reference_acceleration"]
        load = tangential(columns)
        balance = load / self.prior.blend(columns, "mu_c")
        kept = np.where(acceleration < 0.1, g.smoothing, 1.0)
        f_slip = np.where(f_slip < 0.0, balance, kept * f_slip + (1.0 - kept) * balance)
        v_cmd = columns["reference_velocity"] + g.k_x * (columns["reference_position"] - x)
        distance = columns["distance"]
        arrived = (columns["reference_position"] >= distance) & (x >= distance - g.stop_band)
        error = np.where(arrived, error, error + (v_cmd - v) * self._dt)
        force = f_slip * (1.0 + g.k_a * acceleration + g.k_v * (v - v_cmd)) - g.k_e * error
        firm = g.hold_margin * load / self.prior.hold(columns, "mu_c")
        force = np.where(arrived, np.maximum(force, firm), force)
        return force, np.column_stack((error, f_slip))
