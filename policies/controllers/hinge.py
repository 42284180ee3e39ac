"""Lets the object hang upright while the wrist pitches."""

from __future__ import annotations

from typing import Self

import numpy as np
from pydantic import Field, model_validator

from policies.controllers.base import Columns, State
from policies.controllers.gains import Fraction, GainPolicy
from policies.controllers.sensing import ConservativePrior, both, tangential
from slipgym.config.base import Frozen, NonNegative, Positive


class HingeGains(Frozen):
    """Gains of `HingePolicy`."""

    k_stick: Positive = Field(
        default=1.2, description="Ratio k before the object first turns in the grip [-]"
    )
    k_blind: Positive = Field(default=0.95, description="The same with the conservative mu_c [-]")
    release: Positive = Field(default=0.05, description="Tilt from which k_blind falls [rad]")
    k_slip: Positive = Field(default=2.0, description="Ratio k at the target tilt [-]")
    k_min: Positive = Field(default=1.1, description="Least ratio k while the object turns in the grip [-]")
    k_max: Positive = Field(default=3.0, description="Largest ratio k [-]")
    k_a: NonNegative = Field(default=45.0, description="Gain on the tilt [1/rad]")
    k_w: NonNegative = Field(default=6.0, description="Gain on the rate of the tilt [s/rad]")
    target: float = Field(default=0.065, description="Tilt to hold [rad]")
    onset: NonNegative = Field(
        default=0.005, description="Turn from which the object counts as turning in the grip [rad]"
    )
    smoothing: Fraction = Field(
        default=0.9, description="Weight of the old tangential force in each control step [-]"
    )

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        if self.k_min > self.k_max:
            raise ValueError(f"needs k_min <= k_max, got k_min = {self.k_min!r}, k_max = {self.k_max!r}")
        return self


class HingePolicy(GainPolicy[HingeGains]):
    """Grip as hard as keeps the object's tilt where slide and tilt are both allowed.

    With k = mu_c f_n / f_t the limit surface lets the object slide r / sqrt(k^2 - 1) per radian of the
    turn, and drags it to a tilt of about r sqrt(k^2 - 1) / d under its centre of mass, d deep. Neither r
    nor d needs to be known: the tilt itself, wrist pitch plus measured slip, says how k has to change.

        f = k f_t / mu_c,    k = k_slip + k_a (target - tilt) - k_w tilt',    within [k_min, k_max]

    The gripper's public controller holds k at 1.4 (arXiv 2410.19660). Until the object first turns in the
    grip it holds by static friction, which is larger: with the same k the wrist would take it along
    beyond what is allowed, and it would swing when it breaks away. So k is then k_stick, between 1 and
    mu_s / mu_c, and the first degrees of the turn show when friction lets go. Where friction is not known
    yet it is k_blind, with the prior's mu_c. If friction still holds at the tilt `release`, it is larger than
    that, and the grip falls with the tilt from there, so that it lets go in time.

    Args:
        gains: See `HingeGains`; each is a keyword argument of its own, too.
        prior: Friction assumed until the estimate has confidence; more than elsewhere, as the first
            samples after the break-away, near static friction, say too much.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "Hinge"
    Gains = HingeGains
    prior_default = ConservativePrior(confidence=0.2)

    def initial_state(self, n: int) -> np.ndarray:
        """Filtered tangential force, (n, 1) [N]; a negative one has no sample yet."""
        return np.full((n, 1), -1.0)

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        g = self.gains
        old, load = np.asarray(state)[:, 0], tangential(columns)
        load = np.where(old < 0.0, load, g.smoothing * old + (1.0 - g.smoothing) * load)
        turned, side = columns["measured_slip_theta"], np.sign(columns["wrist_pitch_goal"])
        tilt = side * (columns["wrist_pitch"] + turned)
        rate = side * (columns["wrist_pitch_rate"] + both(columns, "omega"))
        k = g.k_slip + g.k_a * (g.target - tilt) - g.k_w * rate
        k = np.clip(k, g.k_min, g.k_max)
        weight = self.prior.confidence_weight(columns, "mu_c")
        blind = g.k_blind * g.release / np.maximum(np.abs(tilt), g.release)
        start = weight * g.k_stick + (1.0 - weight) * blind
        k = np.where(np.abs(turned) > g.onset, k, start)
        return k * load / self.prior.blend(columns, "mu_c"), load[:, np.newaxis]
