"""Lets the object hang upright while the wrist pitches."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Self

import numpy as np
from pydantic import model_validator

from policies.controllers.base import Columns, State
from policies.controllers.exploration import ActiveExploration, ExplorationState
from policies.controllers.gains import Fraction, Gain, GainPolicy
from policies.controllers.sensing import ConservativePrior, both, scaled_speed, tangential
from slipgym.config import Overrides
from slipgym.config.base import Frozen, NonNegative, Positive

_EXPLORATION = ActiveExploration()
_REST = 0.01
"""Pitch rate of the wrist up to which friction is explored [rad/s]."""


class HingeGains(Frozen):
    """Gains of `HingePolicy`."""

    k_stick: Positive = Gain(1.2, "Ratio k before the object first turns in the grip [-]")
    k_blind: Positive = Gain(0.95, "The same with the conservative mu_c [-]")
    release: Positive = Gain(0.05, "Tilt from which k_blind falls [rad]")
    k_slip: Positive = Gain(1.8, "Ratio k at the target tilt [-]")
    k_min: Positive = Gain(1.1, "Least ratio k while the object turns in the grip [-]")
    k_max: Positive = Gain(3.0, "Largest ratio k [-]")
    k_a: NonNegative = Gain(25.0, "Gain on the tilt [1/rad]")
    k_w: NonNegative = Gain(6.0, "Gain on the rate of the tilt [s/rad]")
    target: float = Gain(0.072, "Tilt to hold [rad]")
    onset: NonNegative = Gain(0.005, "Turn from which the object counts as turning in the grip [rad]")
    known: NonNegative = Gain(
        0.005, "Confidence up to which friction is explored before the turn; 0: never [-]"
    )
    smoothing: Fraction = Gain(0.9, "Weight of the old tangential force in each control step [-]")

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
    mu_s / mu_c, and the first degrees of the turn show when friction lets go.

    So friction has to be known before the turn. While the wrist still rests, the grip is lowered until the
    object slips a little (`policies.controllers.exploration`), until the estimate has the confidence `known`.
    What the exploration itself shows counts beside the estimate: a slip may be too short for an estimator,
    and the smallest grip may hold a light object. Without exploration k is k_blind, with the prior's mu_c,
    for as long as friction is unknown. If friction still holds at the tilt `release`, it is larger than that,
    and the grip falls with the tilt from there, so that it lets go in time.

    Arguments are those of `GainPolicy`. Its own prior counts for as long as friction is explored, and without
    exploration for longer than elsewhere, as the first samples after the break-away of a turn, near static
    friction, say too much.
    """

    task = "Hinge"
    remembers_slips = True
    Gains = HingeGains
    prior_default = ConservativePrior(confidence=0.005)
    without_friction: ClassVar[Mapping[str, Any]] = {"known": 0.0}

    def _prepare(self, config: Overrides | None) -> None:
        if self.gains.known == 0.0 and self.prior is self.prior_default:
            self.prior = ConservativePrior(confidence=0.2)

    def initial_state(self, n: int) -> np.ndarray:
        """Filtered tangential force, level of the exploration [N], `ExplorationState`, (n, 7).

        The first two are < 0 before the first step.
        """
        return np.tile([-1.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0], (n, 1))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        g, load = self.gains, tangential(columns)
        old, level, *explored = np.asarray(state).T
        seen = ExplorationState(*explored)
        smooth = np.where(old < 0.0, load, g.smoothing * old + (1.0 - g.smoothing) * load)
        turned, side = columns["measured_slip_theta"], np.sign(columns["wrist_pitch_goal"])
        tilt = side * (columns["wrist_pitch"] + turned)
        rate = side * (columns["wrist_pitch_rate"] + both(columns, "omega"))
        rests = np.abs(columns["wrist_pitch_rate"]) < _REST
        rests &= np.abs(columns["wrist_pitch"]) < g.onset
        unknown = rests & (columns["confidence_mu_c"] < g.known)
        seen = seen.holding(load, both(columns, "f_n"), unknown)
        k = g.k_slip + g.k_a * (g.target - tilt) - g.k_w * rate
        k = np.clip(k, g.k_min, g.k_max)
        weight = self.prior.confidence_weight(columns, "mu_c")
        blind = np.where(seen.held > 0.0, g.k_stick, g.k_blind)
        blind *= g.release / np.maximum(np.abs(tilt), g.release)
        start = weight * g.k_stick + (1.0 - weight) * blind
        k = np.where(np.abs(turned) > g.onset, k, start)
        force = k * smooth / seen.corrected(self.prior.blend(columns, "mu_c"), columns)
        begun, speed = level >= 0.0, scaled_speed(columns, self.prior.blend(columns, "r"))
        limits = self.config.gripper.force_min, self.config.gripper.force_max
        explores, command, level, seen = _EXPLORATION.act(
            seen, np.where(begun, level, force), load, speed, begun, unknown, limits
        )
        return np.where(explores, command, force), np.column_stack((smooth, level, *seen))
