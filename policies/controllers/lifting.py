"""Lifts an object of unknown friction from a support: the base of the controllers that carry."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, TypeVar

import numpy as np

from estimator.estimate import deviation_of
from policies.controllers.base import Columns, State
from policies.controllers.gains import Fraction, Gain, GainPolicy
from policies.controllers.sensing import both, scaled_speed
from policies.controllers.slip_memory import combined, weight_of
from slipgym.config import Overrides
from slipgym.config.base import Frozen, NonNegative, Positive

_STILL = 3
"""Control steps after which a wrist without velocity rests, and is not just between two moves."""

_RISE = 6.0
"""A grip is made for `lightest` once this many times the load is more."""


class LiftingGains(Frozen):
    """Gains of `LiftingPolicy`."""

    guess: Positive = Gain(2.0, "mu_s assumed before the first slip [-]")
    confidence: Positive = Gain(0.05, "Confidence from which mu_s is taken as it is [-]")
    deviations: NonNegative = Gain(0.2, "Standard deviations by which mu_s is taken below its estimate [-]")
    least: NonNegative = Gain(0.8, "Least grip [N]")
    tare: Fraction = Gain(0.8, "Part of the time on the support in which the forces are zeroed [-]")
    lead: NonNegative = Gain(0.03, "Time by which the grip leads a rising load [s]")
    smoothing: Fraction = Gain(0.8, "Weight of the old load in each control step while the wrist rests [-]")
    lightest: NonNegative = Gain(1.0, "Least load per finger that a grip is made for [N]")
    fall: NonNegative = Gain(0.1, "Fall of the load that is a slip, over the load [-]")
    noise: NonNegative = Gain(0.08, "Fall of the load that is always noise [N]")
    speed: Positive = Gain(2e-3, "Scaled slip speed that is a slip [m/s]")
    catch: Positive = Gain(1.5, "Least factor by which the grip rises then [-]")
    jump: NonNegative = Gain(1.5, "Least share in that rise [-]")
    kick: Positive = Gain(1.5, "Command in the control step of a catch, over the grip wanted [-]")
    shown: NonNegative = Gain(
        0.04, "Deviation of load over grip before a slip, relative; 0: it does not count [-]"
    )
    sure: Positive = Gain(0.8, "Confidence up to which slips are caught [-]")
    rest: NonNegative = Gain(8, "Control steps after a slip without another catch [-]")
    decay: Fraction = Gain(0.97, "Fraction of the grip after a slip that is left a control step later [-]")


L = TypeVar("L", bound=LiftingGains)


class LiftingPolicy(GainPolicy[L]):
    """Grip in proportion to the load from lift-off on, and find friction out while the load is small.

        f = share W / mu_s

    W is the load per finger in the scaled norm of the limit surface while the wrist rests, filtered, and led
    by its rate while it rises; `share` is what the motion needs on top. What the sensors read while the
    support bears the object is their zero error. mu_s is taken some deviations below its estimate. While the
    object slips, mu_c takes its place.

    Before the first slip mu_s is taken as `guess`, more than what may come. The object then slips while the
    load is still small, which shows in the load at the next control step: the grip jumps to what the load
    `lightest` needs at load / grip before the slip, for one control step to more, since the force follows
    late. From then on load / grip before the slip counts for mu_s, and so does the estimate, each with the
    weight of its variance. Without friction in the observation the former alone is a memory of slips.
    """

    remembers_slips, needs_slip = True, False

    def _prepare(self, config: Overrides | None) -> None:
        settings: Any = self.settings
        self._tares = int(self.gains.tare * settings.settle * self.config.physics.control_rate)

    @abstractmethod
    def share(self, columns: Columns) -> np.ndarray:
        """Grip wanted over the least grip that holds the weight, (n,) [-]."""

    def initial_state(self, n: int) -> np.ndarray:
        """Filtered load and last tangential force (negative: none yet), last grip and the one kept [N].

        Then the control steps left without another catch, those since the wrist moved, load over grip
        before the last slip (0: none yet) [-], the zero errors (f_x, f_y, tau) and their samples. Shape
        (n, 11).
        """
        return np.tile([-1.0, -1.0, *(0.0 for _ in range(9))], (n, 1))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        g, share = self.gains, self.share(columns)
        old, before, gripped, kept, rest, still, shown, *zero = np.asarray(state).T
        (f_x, f_y, tau), zero = self._zeroed(columns, np.array(zero))
        r, pulled = self.prior.hold(columns, "r"), np.hypot(f_x, f_y)
        slides = scaled_speed(columns, r) > g.speed
        moves = sum(np.abs(columns[f"wrist_{name}"]) for name in ("velocity_x", "velocity_z", "pitch_rate"))
        still = np.where(np.asarray(moves) == 0.0, still + 1.0, 0.0)
        rests = still > _STILL
        weight, ahead = self._weight(np.hypot(pulled, tau / r), old, rests, slides, rest)
        confidence = columns["confidence_mu_s"]
        trust = np.minimum(1.0, confidence / g.confidence)
        spread = deviation_of(np.clip(confidence, g.confidence, 1.0))
        slips = slides | (before - pulled > np.maximum(g.fall * before, g.noise))
        caught = slips & rests & (rest <= 0.0) & (confidence < g.sure)
        seen = caught & ~slides & (g.shown > 0.0)
        shown = np.where(seen, before / np.maximum(gripped, 1e-3), shown)
        weight_shown = np.where(confidence > 0.0, weight_of(shown, spread, g.shown), np.sign(shown))
        known = combined(columns["mu_s"], shown, weight_shown)
        spread = spread * np.sqrt(1.0 - weight_shown)
        trust = np.where(shown > 0.0, 1.0, trust)
        slower = slides & (columns["confidence_mu_c"] > 0.0)
        mu = np.where(slower, columns["mu_c"], known * np.exp(-g.deviations * spread))
        load = np.maximum(ahead, np.minimum(g.lightest, _RISE * ahead)) / np.maximum(mu, 1e-3)
        force = share * (trust * load + (1.0 - trust) * ahead / g.guess)
        force = np.maximum(force, g.least)
        raised = (
            np.maximum(share, g.jump)
            * gripped
            * np.maximum(g.lightest / np.maximum(before, 2.0 * g.noise), g.catch)
        )
        kept = np.where(caught, raised, g.decay * kept)
        rest = np.where(caught | slides, g.rest, rest - 1.0)
        force = np.maximum(force, kept)
        memory = np.column_stack((weight, pulled, force, kept, rest, still, shown, *zero))
        return np.where(caught, g.kick * force, force), memory

    def _zeroed(self, columns: Columns, zero: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean force and torque per finger (3, n) [N, N, N m] since the support, and those on the support."""
        load = np.array([both(columns, name) for name in ("f_x", "f_y", "tau")])
        samples = zero[3] + (zero[3] < self._tares)
        weight = np.where(samples > zero[3], 1.0 / np.maximum(samples, 1.0), 0.0)
        mean = zero[:3] + weight * (load - zero[:3])
        return load - mean, np.vstack((mean, samples))

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
