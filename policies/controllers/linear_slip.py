"""Controls linear slip along gravity by grip force alone: continuously, in leaps, or as the sensor asks."""

from __future__ import annotations

import numpy as np

from policies.controllers import leaps
from policies.controllers.base import Columns, State
from policies.controllers.gains import Fraction, Gain, GainPolicy
from policies.controllers.lateness import Lateness, LatenessGains, watched
from policies.controllers.leaps import BEGUN, LeapGains, LeapState, Slip
from policies.controllers.sensing import both, scaled_speed, tangential
from slipgym.config import Overrides
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


class LinearSlipLeapGains(LeapGains):
    """Gains of `LinearSlipLeapPolicy`."""

    start: Positive = Gain(1.6, "Grip from which it falls to the first break-away, over f_slip [-]")
    again: Positive = Gain(1.2, "Ratio of the grip after a leap to the grip at the break-away [-]")
    slide: Positive = Gain(0.002, "Longest leap [m]")
    hold_margin: Positive = Gain(1.4, "Grip while holding, over the need [-]")


class LinearSlipLeapPolicy(GainPolicy[LinearSlipLeapGains]):
    """Follows the reference in leaps (`policies.controllers.leaps`), for a slip velocity that arrives late.

    "linear_slip" regulates the slip by its measured velocity: if that is late, the object is caught late. A
    leap begins when the force falls and ends after a planned time. The object then rests until the sensor has
    shown how long the leap was. There is another one if more is left than half of the shortest.
    """

    task = "LinearSlip"
    Gains = LinearSlipLeapGains

    def _prepare(self, config: Overrides | None) -> None:
        self._leaps = leaps.at_rate(self.gains, self.config.physics.control_rate)

    def initial_state(self, n: int) -> np.ndarray:
        """Whether a leap is wanted (0 or 1), last reference [m], columns of `LeapState`, (n, 11)."""
        return np.column_stack((np.zeros((n, 2)), *leaps.begin(n, self._leaps)))

    def caught(self, columns: Columns, load: np.ndarray) -> np.ndarray:
        """Memory, as of `initial_state`, as if a leap were caught now.

        Args:
            columns: n observations.
            load: Load per finger at rest, (n,) [N].
        """
        n, reference = len(columns), columns["reference_position"]
        slips = leaps.begin(n, self._leaps)._replace(
            load=load,
            ratio=self.gains.start / self.prior.blend(columns, "mu_c"),
            clock=np.full(n, -float(self._leaps.rest)),
            steps=np.full(n, float(self._leaps.slide_steps)),
            left=reference + columns["measured_slip_y"],
        )
        return np.column_stack((np.ones(n), reference, *slips))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        memory = np.asarray(state).T
        past, slips, reference = memory[0] > 0.0, LeapState(*memory[2:]), columns["reference_position"]
        left = reference + columns["measured_slip_y"]
        slips = slips._replace(left=slips.left + reference - memory[1])  # what a leap leaves does not grow
        worth = left > 0.5 * slips.reach * BEGUN**2
        between = (slips.clock == -1.0) | ((slips.clock == 0.0) & ~past)
        wanted = np.where(between, worth, past)
        load, never = tangential(columns), np.zeros(len(columns), dtype=bool)
        need = np.maximum(load / self.prior.hold(columns, "mu_c"), slips.ratio * slips.load)
        asked = Slip(
            wanted=wanted,
            begins=wanted & (slips.ratio == 0.0),
            turning=never,
            distance=left,
            load=load,
            speed=scaled_speed(columns, self.prior.blend(columns, "r")),
            f_slip=1.0 / self.prior.blend(columns, "mu_c"),
            held=self.gains.hold_margin * need,
        )
        force, slips = leaps.leap(slips, asked, self._leaps, self.config.gripper.force_max)
        return force, np.column_stack((wanted, reference, *slips))


class LinearSlipGains(LatenessGains, ContinuousLinearSlipGains):
    """Gains of `LinearSlipPolicy`, those of the continuous slip among them."""


class LinearSlipPolicy(GainPolicy[LinearSlipGains]):
    """Slips continuously (`ContinuousLinearSlipPolicy`), and in leaps once the velocity was late.

    It watches the slips (`policies.controllers.lateness`): if the velocity shows a slip later than `prompt`
    after the force has fallen, or a slip overtakes the reference by `longest`, it goes on in leaps
    (`LinearSlipLeapPolicy`). With a prompt velocity it is the continuous controller. That also slips at the
    load of the hold, so that an estimator is sure of friction there.

    Arguments are those of `GainPolicy`; leaps have the default gains.
    """

    task = "LinearSlip"
    Gains = LinearSlipGains

    def _prepare(self, config: Overrides | None) -> None:
        chosen = {name: getattr(self.gains, name) for name in ContinuousLinearSlipGains.model_fields}
        self._continuous = ContinuousLinearSlipPolicy(prior=self.prior, config=config, **chosen)
        self._leaps = LinearSlipLeapPolicy(prior=self.prior, config=config)
        own = len(Lateness._fields)
        self._parts = own, own + self._continuous.initial_state(1).shape[1]  # where the other memories begin

    def initial_state(self, n: int) -> np.ndarray:
        """Columns of `Lateness`, then the memories of the continuous slip and of the leaps, (n, 19)."""
        watch = np.zeros((n, len(Lateness._fields)))
        return np.column_stack((watch, self._continuous.initial_state(n), self._leaps.initial_state(n)))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        watch, slip, leap = np.split(np.asarray(state), self._parts, axis=1)
        speed = scaled_speed(columns, self.prior.blend(columns, "r"))
        seen = watched(
            Lateness(*watch.T),
            tangential(columns),
            speed,
            -columns["measured_slip_y"] - columns["reference_position"],
            self.gains,
            self._leaps.gains,
            self._dt,
        )
        late = seen.late > 0.0
        slipping, slip = self._continuous.control(columns, slip)
        leaping, leapt = self._leaps.control(columns, leap)
        ready = self._leaps.caught(columns, seen.load)
        force = np.where(late, leaping, slipping)
        return force, np.column_stack((*seen, slip, np.where(late[:, None], leapt, ready)))
