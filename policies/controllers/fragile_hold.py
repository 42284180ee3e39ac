"""Lifts and carries an object with a grip between slip and breakage."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from pydantic import Field

from policies.controllers.base import Columns, State
from policies.controllers.gains import Fraction, GainPolicy
from policies.controllers.sensing import scaled_load, scaled_speed, tangential
from slipgym.config.base import Frozen, NonNegative, Positive


class FragileHoldGains(Frozen):
    """Gains of `FragileHoldPolicy`."""

    place: Fraction = Field(
        default=0.45, description="Place of the grip between least and breaking force, logarithmic [-]"
    )
    guess: Positive = Field(default=2.0, description="mu_s assumed before the first slip [-]")
    confidence: Positive = Field(default=0.05, description="Confidence from which mu_s is taken as it is [-]")
    least: NonNegative = Field(default=0.8, description="Least grip [N]")
    lead: NonNegative = Field(default=0.05, description="Time by which the grip leads a rising load [s]")
    smoothing: Fraction = Field(
        default=0.8, description="Weight of the old load in each control step while the wrist rests [-]"
    )
    lightest: NonNegative = Field(default=1.0, description="Load per finger of the lightest object [N]")
    fall: NonNegative = Field(default=0.12, description="Fall of the load that is a slip, over the load [-]")
    noise: NonNegative = Field(default=0.08, description="Fall of the load that is always noise [N]")
    speed: Positive = Field(default=2e-3, description="Scaled slip speed that is a slip [m/s]")
    catch: Positive = Field(default=1.5, description="Least factor by which the grip rises then [-]")
    rest: NonNegative = Field(default=5, description="Control steps after a slip without another catch [-]")
    decay: Fraction = Field(
        default=0.97, description="Fraction of the grip after a slip that is left a control step later [-]"
    )


class FragileHoldPolicy(GainPolicy[FragileHoldGains]):
    """Grip between the least force that holds the object and the force that breaks it.

        f = allowance^place W (a / g) / mu_s

    W is the load per finger in the scaled norm of the limit surface while the wrist rests, filtered, and led by
    its rate while it rises; a is the largest acceleration of the plan. The grip rises with the load while the
    support gives way, and stays then. While the object slips, mu_c takes the place of mu_s.

    Before the first slip mu_s is taken as `guess`, more than what may come. The object then slips while the
    load is still small, which shows in the load at the next control step: the grip jumps to what the lightest
    object needs at load / grip before the slip, the estimator learns friction, and the law takes over. Without
    friction in the observation mu_s stays at a guess, for which the middle of the range serves best.

    Args:
        gains: See `FragileHoldGains`; each is a keyword argument of its own, too.
        prior: As in the other controllers; here r alone is used.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "FragileHold"
    Gains = FragileHoldGains
    without_friction: ClassVar[Mapping[str, Any]] = {"guess": 0.5}

    def initial_state(self, n: int) -> np.ndarray:
        """Filtered load and last tangential force (negative: none yet), last grip and the one kept [N], rest.

        Shape (n, 5).
        """
        return np.tile([-1.0, -1.0, 0.0, 0.0, 0.0], (n, 1))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        g = self.gains
        old, before, gripped, kept, rest = np.asarray(state).T
        r, pulled = self.prior.hold(columns, "r"), tangential(columns)
        slides = scaled_speed(columns, r) > g.speed
        moves = sum(np.abs(columns[f"wrist_{name}"]) for name in ("velocity_x", "velocity_z", "pitch_rate"))
        rests = np.asarray(moves) == 0.0
        weight, ahead = self._weight(scaled_load(columns, r), old, rests, slides, rest)
        share = columns["allowance"] ** g.place * columns["peak_acceleration"] / self.config.physics.gravity
        trust = np.minimum(1.0, columns["confidence_mu_s"] / g.confidence)
        mu = np.where(slides, columns["mu_c"], columns["mu_s"])
        known = np.maximum(ahead, g.lightest) / np.maximum(mu, 1e-3)
        force = np.maximum(share * (trust * known + (1.0 - trust) * ahead / g.guess), g.least)
        slips = slides | (before - pulled > np.maximum(g.fall * before, g.noise))
        caught = slips & rests & (rest <= 0.0) & (trust < 1.0)
        raised = share * gripped * np.maximum(g.lightest / np.maximum(before, 2.0 * g.noise), g.catch)
        kept = np.where(caught, raised, g.decay * kept)
        rest = np.where(caught | slides, g.rest, rest - 1.0)
        force = np.maximum(force, kept)
        return force, np.column_stack((weight, pulled, force, kept, rest))

    def _weight(
        self, load: np.ndarray, old: np.ndarray, rests: np.ndarray, slides: np.ndarray, rest: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Filtered load at rest, and what it will be when the grip follows, (n,) each [N].

        While the object slips, friction carries less than the load: then the old value counts.
        """
        s = self.gains.smoothing
        weight = np.where(rests, s * old + (1.0 - s) * load, old)
        weight = np.where(slides, np.maximum(weight, old), weight)
        weight = np.where(old < 0.0, load, weight)
        delay = self.gains.lead * self.config.physics.control_rate * (1.0 - s) / s + 1.0
        rises = rests & ~slides & (rest <= 0.0)
        return weight, weight + np.where(rises, np.maximum(delay * (load - weight), 0.0), 0.0)
