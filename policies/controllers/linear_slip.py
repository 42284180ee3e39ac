"""Controls linear slip along gravity by grip force alone, in leaps if the slip velocity is late."""

from __future__ import annotations

import numpy as np

from policies.controllers.base import Columns, State
from policies.controllers.gains import GainPolicy
from policies.controllers.lateness import Lateness, LatenessGains, watched
from policies.controllers.linear_slip_continuous import ContinuousLinearSlipGains, ContinuousLinearSlipPolicy
from policies.controllers.linear_slip_leaps import LinearSlipLeapPolicy
from policies.controllers.sensing import scaled_speed, tangential
from slipgym.config import Overrides


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
