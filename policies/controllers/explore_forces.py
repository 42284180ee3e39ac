"""Collects what an exploration has seen in the forces: ratios of break-aways, slides and turns.

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
from policies.controllers.force_friction import Found, Ratios, solve
from policies.controllers.sensing import both, tangential


class Forces(NamedTuple):
    """Memory of the forces, arrays (n,); all 0 at the start."""

    response: np.ndarray
    """Normal force over the command while the grip falls, smoothed; 0: none yet [-]."""
    newest: np.ndarray
    """Size of the torque in this control step [N m], the tangential and the normal force [N]."""
    newest_force: np.ndarray
    newest_normal: np.ndarray
    before: np.ndarray
    """Torque a control step before that [N m]."""
    static_weight: np.ndarray
    """Of the break-aways, see `Ratios`."""
    static_disc_force: np.ndarray
    static_disc_torque: np.ndarray
    static_force: np.ndarray
    static_torque: np.ndarray
    slide_weight: np.ndarray
    """Of the slides."""
    slide_disc_force: np.ndarray
    slide_disc_torque: np.ndarray
    slide_force: np.ndarray
    slide_torque: np.ndarray
    turn_weight: np.ndarray
    """Of the turns."""
    turn_disc_force: np.ndarray
    turn_disc_torque: np.ndarray
    turn_force: np.ndarray
    turn_torque: np.ndarray

    def ratios(self) -> tuple[Ratios, Ratios, Ratios]:
        """Those of break-aways, slides and turns."""
        return Ratios(*self[5:10]), Ratios(*self[10:15]), Ratios(*self[15:])

    def found(self, turned: np.ndarray, r: np.ndarray, shared: np.ndarray) -> Found:
        """Friction by forces.

        Args:
            turned: Whether a turn was seen in the grip, (n,) bool.
            r: Contact radius before that, (n,) [m].
            shared: Relative deviation that all samples share, (n,) [-].
        """
        static, slide, turn = self.ratios()
        return solve(static, slide, turn._replace(weight=np.where(turned, turn.weight, 0.0)), r, shared)


class Events(NamedTuple):
    """Events of a control step, arrays (n,)."""

    falls: np.ndarray
    """Control steps since the grip began to fall; negative where it does not."""
    keep: np.ndarray
    """Fraction of the grip that is left a control step later while it falls [-]."""
    slips: np.ndarray
    """Whether a slip is noticed."""
    slides: np.ndarray
    """Whether the object may still slide."""
    turns: np.ndarray
    """Whether the wrist turns under the object."""
    force: np.ndarray
    """Tangential force per finger at rest [N]."""
    torque: np.ndarray
    """Torque per finger at rest [N m]."""
    r: np.ndarray
    """Contact radius so far [m]."""


def watch(columns: Columns, past: Forces, g: ForceGains, now: Events) -> Forces:
    """The memory after the present observation.

    Args:
        columns: n observations.
        past: The memory before.
        g: Gains.
        now: What happens.
    """
    f_t, f_n, tau = tangential(columns), np.maximum(both(columns, "f_n"), 1e-3), both(columns, "tau")
    static, slide, turn = past.ratios()
    response, static = _break_away(columns, past.response, static, g, now)

    slides = now.slides & _slides(f_t, f_n, tau, static, g, now)
    variance = (g.sd_normal / f_n) ** 2 + (g.sd_force / np.maximum(f_t, 1e-3)) ** 2 + g.sd_sample**2
    slide = slide.add(slides, variance, f_t / f_n - g.viscous, tau / f_n, now.r)

    three = np.array([past.before, past.newest, np.abs(tau)])
    turns = now.turns & (three.min(axis=0) > g.plateau * three.max(axis=0))
    turns &= np.abs(both(columns, "omega")) > g.spin
    normal, torque = np.maximum(past.newest_normal, 1e-3), np.maximum(past.newest, 1e-6)
    variance = (g.sd_normal / normal) ** 2 + (g.sd_torque / torque) ** 2 + g.sd_sample**2
    turn = turn.add(turns, variance, past.newest_force / normal, torque / normal, now.r)
    return Forces(response, np.abs(tau), f_t, f_n, past.newest, *static, *slide, *turn)


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
