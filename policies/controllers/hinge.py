"""Lets the object hang upright while the wrist pitches."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Self

import numpy as np
from pydantic import Field, model_validator

from policies.controllers.base import Columns, State
from policies.controllers.exploration import ActiveExploration, ExplorationState
from policies.controllers.gains import Fraction, GainPolicy, renamed
from policies.controllers.sensing import ConservativePrior, both, scaled_speed, tangential
from slipgym.config import Overrides
from slipgym.config.base import Frozen, NonNegative, Positive

_EXPLORATION = ActiveExploration()
_UNEXPLORED = ConservativePrior(confidence=0.2)
_REST = 0.01
"""Pitch rate of the wrist up to which friction is explored [rad/s]."""


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
    target: float = Field(default=0.072, description="Tilt to hold [rad]")
    onset: NonNegative = Field(
        default=0.005, description="Turn from which the object counts as turning in the grip [rad]"
    )
    known: NonNegative = Field(
        default=0.005, description="Confidence up to which friction is explored before the turn; 0: never [-]"
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
    mu_s / mu_c, and the first degrees of the turn show when friction lets go.

    So friction has to be known before the turn. While the wrist still rests, the grip is lowered until the
    object slips a little (`policies.controllers.exploration`), until the estimate has the confidence `known`.
    That suits estimators whose first update gives the answer; with "rls" choose known=0. Where friction is
    unknown, k is k_blind, with the prior's mu_c. If friction still holds at the tilt `release`, it is larger
    than that, and the grip falls with the tilt from there, so that it lets go in time.

    Args:
        gains: See `HingeGains`; each is a keyword argument of its own, too.
        prior: Friction assumed until the estimate has confidence; None: for as long as friction is explored,
            and without exploration for longer than elsewhere, as the first samples after the break-away of a
            turn, near static friction, say too much.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "Hinge"
    Gains = HingeGains
    prior_default = ConservativePrior(confidence=0.005)
    without_friction: ClassVar[Mapping[str, Any]] = {"known": 0.0}

    def __init__(
        self,
        gains: HingeGains | None = None,
        prior: ConservativePrior | None = None,
        config: Overrides | None = None,
        **parameters: Any,
    ) -> None:
        parameters = renamed(parameters)
        prior = parameters.pop("prior", prior)
        super().__init__(gains, prior, config, **parameters)
        if prior is None and self.gains.known == 0.0:
            self.prior = _UNEXPLORED

    def initial_state(self, n: int) -> np.ndarray:
        """Filtered tangential force, level of the exploration [N], `ExplorationState`, (n, 6).

        The first two are < 0 before the first step. Without exploration the first alone, (n, 1).
        """
        if self.gains.known == 0.0:
            return np.full((n, 1), -1.0)
        state = np.zeros((n, 2 + len(ExplorationState._fields)))
        state[:, :2], state[:, -1] = -1.0, 1.0
        return state

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        g, memory = self.gains, np.asarray(state).T
        old, load = memory[0], tangential(columns)
        smooth = np.where(old < 0.0, load, g.smoothing * old + (1.0 - g.smoothing) * load)
        turned, side = columns["measured_slip_theta"], np.sign(columns["wrist_pitch_goal"])
        tilt = side * (columns["wrist_pitch"] + turned)
        rate = side * (columns["wrist_pitch_rate"] + both(columns, "omega"))
        k = g.k_slip + g.k_a * (g.target - tilt) - g.k_w * rate
        k = np.clip(k, g.k_min, g.k_max)
        weight = self.prior.confidence_weight(columns, "mu_c")
        blind = g.k_blind * g.release / np.maximum(np.abs(tilt), g.release)
        start = weight * g.k_stick + (1.0 - weight) * blind
        k = np.where(np.abs(turned) > g.onset, k, start)
        force = k * smooth / self.prior.blend(columns, "mu_c")
        if g.known == 0.0:
            return force, smooth[:, np.newaxis]
        explores, command, kept = self._explore(columns, memory[1:], force, load)
        return np.where(explores, command, force), np.column_stack((smooth, *kept))

    def _explore(
        self, columns: Columns, memory: np.ndarray, force: np.ndarray, load: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
        """Whether friction is explored (n,), the grip then (n,) [N], and the memory of it."""
        begun, seen = memory[0] >= 0.0, ExplorationState(*memory[1:])
        seen = seen._replace(load=np.where(begun, seen.load, load))
        level = np.where(begun, memory[0], force)
        rests = (np.abs(columns["wrist_pitch_rate"]) < _REST) & (
            np.abs(columns["wrist_pitch"]) < self.gains.onset
        )
        wanted = begun & rests & (columns["confidence_mu_c"] < self.gains.known)
        slips = _EXPLORATION.slipping(seen, load, scaled_speed(columns, self.prior.blend(columns, "r")))
        limits = self.config.gripper.force_min, self.config.gripper.force_max
        explores, command, level, seen = _EXPLORATION.act(seen, level, slips, wanted, limits)
        seen = seen._replace(load=seen.load + _EXPLORATION.smoothing * (load - seen.load))
        return explores, command, [level, *seen]
