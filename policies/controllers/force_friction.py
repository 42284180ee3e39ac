"""Friction by forces alone: from the load at a break-away, in the slide after it, and in a turn.

The limit surface of a pad lies between that of a uniform disc and the ellipsoid of Waltersson &
Karayiannidis (arXiv 2507.06824, eqs. 1-2), and both are close to

    (f_t / f_n)^p + (tau / (r f_n))^p = mu^p,    p = 1.7 for the disc, 2 for the ellipsoid.

A slide and a turn give two such equations, linear in mu_c^p and r^-p; with r a break-away gives mu_s. The
velocity is not needed, so its delay does no harm.

A break-away shows mu_s: the load at rest over the normal force a moment before the force falls. As the grip
falls in proportion, the normal force is the command times a factor, which is smoothed. In the slide that
follows friction is off the load (Newton's second law), and shows mu_c. Where the wrist turns under the object
the torque rises to what friction carries and stays there: a sample between two alike, with a slip rate, shows
mu_c and r.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from policies.controllers.base import Columns
from policies.controllers.explore_gains import ForceGains
from policies.controllers.sensing import both, tangential

DISC, ELLIPSOID = 1.7, 2.0
"""Exponents p of the limit surfaces; the disc's to 1 %."""
SMALLEST, LARGEST = 0.002, 0.015
"""Range of r [m]."""


class Ratios(NamedTuple):
    """Weighted sums of what one kind of event has shown, (n,) each; all 0 at the start."""

    weight: np.ndarray  # sum of 1 / variance of the logarithm of the load over the normal force [-]
    disc_force: np.ndarray  # weighted sum of (f_t / f_n)^p with the exponent of the disc [-]
    disc_torque: np.ndarray  # weighted sum of (tau / f_n)^p
    force: np.ndarray  # with the exponent of the ellipsoid
    torque: np.ndarray

    def add(
        self, shown: np.ndarray, variance: np.ndarray, force: np.ndarray, torque: np.ndarray, r: np.ndarray
    ) -> Ratios:
        """The sums after another sample, in the rows where something is `shown`.

        The less its torque, the less its load depends on the limit surface, and the more it counts.

        Args:
            shown: Whether, (n,).
            variance: Of the logarithm of the ratio, (n,) [-].
            force: f_t / f_n, (n,) [-].
            torque: tau / f_n, (n,) [m].
            r: Contact radius so far, (n,) [m].
        """
        share = np.abs(torque) / (r * np.maximum(force, 1e-6))
        disc, ellipsoid = (np.log1p(share**p) / p for p in (DISC, ELLIPSOID))
        weight = np.where(shown, 1.0 / (variance + (disc - ellipsoid) ** 2 / 12.0), 0.0)
        powers = [part**p for p in (DISC, ELLIPSOID) for part in (np.abs(force), np.abs(torque))]
        added = [old + weight * power for old, power in zip(self[1:], powers, strict=True)]
        return Ratios(self.weight + weight, *added)

    def means(self, ellipsoid: bool) -> tuple[np.ndarray, np.ndarray]:
        """Means of (f_t / f_n)^p and (tau / f_n)^p, (n,) each; close to 0 without a sample."""
        weight = np.maximum(self.weight, 1e-12)
        force, torque = self[3:] if ellipsoid else self[1:3]
        return np.maximum(force / weight, 1e-12), np.maximum(torque / weight, 1e-12)


class Found(NamedTuple):
    """Friction by forces, (3, n) each: mu_s, mu_c [-], r [m]."""

    values: np.ndarray
    """1 where nothing is known."""
    deviations: np.ndarray
    """Relative standard deviations [-]; infinity where nothing is known."""


def solve(static: Ratios, slide: Ratios, turn: Ratios, r: np.ndarray, shared: np.ndarray) -> Found:
    """Friction from the ratios of all break-aways, slides and turns so far.

    Args:
        static: Of the break-aways.
        slide: Of the slides.
        turn: Of the turns.
        r: Contact radius where no turn has shown it, (n,) [m].
        shared: Relative deviation of a ratio of forces that all samples share, (n,) [-].
    """
    ends = np.log([_surface(static, slide, turn, r, kind) for kind in (False, True)])
    shape = (ends[1] - ends[0]) ** 2 / 12.0
    noise = [1.0 / np.maximum(sums.weight, 1e-12) for sums in (static, slide, turn)]
    noise[2] = noise[2] + noise[1]
    known = np.array([static.weight > 0.0, slide.weight > 0.0, (slide.weight > 0.0) & (turn.weight > 0.0)])
    deviations = np.sqrt(shape + np.array(noise) + shared**2)
    return Found(np.where(known, np.exp(ends.mean(axis=0)), 1.0), np.where(known, deviations, np.inf))


def _surface(static: Ratios, slide: Ratios, turn: Ratios, r: np.ndarray, ellipsoid: bool) -> np.ndarray:
    """mu_s, mu_c and r on a limit surface, (3, n)."""
    p = ELLIPSOID if ellipsoid else DISC
    (f_s, tau_s), (f_c, tau_c), (f_r, tau_r) = (sums.means(ellipsoid) for sums in (static, slide, turn))
    seen = (slide.weight > 0.0) & (turn.weight > 0.0)
    # mu_c^p = f_c + tau_c / r^p = f_r + tau_r / r^p
    shown = np.maximum(f_c - f_r, 1e-9) / np.maximum(tau_r - tau_c, 1e-12)
    inverse = np.where(seen, np.clip(shown, LARGEST**-p, SMALLEST**-p), r**-p)
    mu_s, mu_c = f_s + tau_s * inverse, f_c + tau_c * inverse
    return np.array([mu_s, mu_c, 1.0 / inverse]) ** (1.0 / p)


def merge(observed: np.ndarray, deviations: np.ndarray, own: Found) -> tuple[np.ndarray, np.ndarray]:
    """Observed friction and one's own, each with the weight of its variance.

    Args:
        observed: mu_s, mu_c, r, (3, n).
        deviations: Their relative standard deviations, (3, n); 0 for friction that is known.
        own: What forces have shown.

    Returns:
        The values and their relative deviations, (3, n) each: the smaller of both, since both come from the
        same samples, and larger where they contradict each other.
    """
    square, other = deviations**2, np.minimum(own.deviations, 1e6) ** 2
    weight, gap = square / (square + other), np.log(own.values / observed)
    contradiction = np.maximum(np.abs(gap) / np.sqrt(square + other), 1.0)
    return observed * np.exp(weight * gap), np.minimum(deviations, own.deviations) * contradiction


class Forces(NamedTuple):
    """Memory of the forces, arrays (n,) and `Ratios`; all 0 at the start."""

    response: np.ndarray  # normal force over the command while the grip falls, smoothed; 0: none yet [-]
    newest: np.ndarray  # size of the torque in this control step [N m]
    newest_force: np.ndarray  # tangential force in it [N]
    newest_normal: np.ndarray  # normal force in it [N]
    before: np.ndarray  # torque a control step before that [N m]
    static: Ratios  # of the break-aways
    slide: Ratios  # of the slides
    turn: Ratios  # of the turns


class Events(NamedTuple):
    """Events of a control step, arrays (n,)."""

    falls: np.ndarray  # control steps since the grip began to fall; negative where it does not
    keep: np.ndarray  # fraction of the grip that is left a control step later while it falls [-]
    slips: np.ndarray  # whether a slip is noticed
    slides: np.ndarray  # whether the object may still slide
    turns: np.ndarray  # whether the wrist turns under the object
    force: np.ndarray  # tangential force per finger at rest [N]
    torque: np.ndarray  # torque per finger at rest [N m]
    r: np.ndarray  # contact radius so far [m]


def watch(columns: Columns, past: Forces, g: ForceGains, now: Events) -> Forces:
    """The memory after the present observation.

    Args:
        columns: n observations.
        past: The memory before.
        g: Gains.
        now: What happens.
    """
    f_t, f_n, tau = tangential(columns), np.maximum(both(columns, "f_n"), 1e-3), both(columns, "tau")
    response, static = _break_away(columns, past.response, past.static, g, now)

    slides = now.slides & _slides(f_t, f_n, tau, static, g, now)
    variance = (g.sd_normal / f_n) ** 2 + (g.sd_force / np.maximum(f_t, 1e-3)) ** 2 + g.sd_sample**2
    slide = past.slide.add(slides, variance, f_t / f_n - g.viscous, tau / f_n, now.r)

    three = np.array([past.before, past.newest, np.abs(tau)])
    turns = now.turns & (three.min(axis=0) > g.plateau * three.max(axis=0))
    turns &= np.abs(both(columns, "omega")) > g.spin
    normal, torque = np.maximum(past.newest_normal, 1e-3), np.maximum(past.newest, 1e-6)
    variance = (g.sd_normal / normal) ** 2 + (g.sd_torque / torque) ** 2 + g.sd_sample**2
    turn = past.turn.add(turns, variance, past.newest_force / normal, torque / normal, now.r)
    return Forces(response, np.abs(tau), f_t, f_n, past.newest, static, slide, turn)


def _break_away(
    columns: Columns, past: np.ndarray, static: Ratios, g: ForceGains, now: Events
) -> tuple[np.ndarray, Ratios]:
    """The smoothed normal force over the command, (n,) [-], and the ratios of the break-aways."""
    f_n, command = both(columns, "f_n"), np.maximum(columns["commanded_force"], 1e-3)
    follows = (now.falls >= g.follows) & ~now.slips
    weight = np.where(follows, np.where(past == 0.0, 1.0, g.smoothing), 0.0)
    response = np.where((now.falls < 0.0) | now.slips, 0.0, past + weight * (f_n / command - past))
    smoothed = np.where(past > 0.0, past * command, f_n)
    normal = np.maximum(smoothed, 1e-3) * now.keep**-g.instant
    noise = np.where(past > 0.0, np.sqrt(g.smoothing / (2.0 - g.smoothing)), 1.0) * g.sd_normal
    variance = (noise / normal) ** 2 + g.sd_break**2
    return response, static.add(now.slips, variance, now.force / normal, now.torque / normal, now.r)


def _slides(
    f_t: np.ndarray, f_n: np.ndarray, tau: np.ndarray, static: Ratios, g: ForceGains, now: Events
) -> np.ndarray:
    """Whether the object surely slides, (n,): friction is off the load, along it, and not too small."""
    size, rest = np.hypot(f_t, tau / now.r), np.hypot(now.force, now.torque / now.r)
    off = (size > g.pushed * rest) | (size < g.pulled * rest)
    turned = np.abs(np.abs(tau) * now.force - np.abs(now.torque) * f_t) / (now.r * f_t * now.force + 1e-12)
    force, torque = static.means(True)
    return off & (turned < g.aside) & (size > g.least * f_n * np.sqrt(force + torque / now.r**2))
