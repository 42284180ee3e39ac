"""Draws what coupled and decoupled friction do to an object that slides and turns."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lab.suite import scenes, truth
from lab.suite.rig import R, Variant, library
from lab.suite.scenes import GAMMAS, SLIDING

SPEED = 0.05
"""Speed at which objects are thrown along x [m/s]."""
SPINS = 0.0, 0.5, 1.0, 1.5, 2.0, 3.0
"""Spin r omega of the throws over that speed [-]."""
COLOURS = "#0072B2", "#56B4E9", "#D55E00", "#009E73", "#CC79A7", "#E69F00"  # Okabe and Ito
_CURVE = np.sin(np.linspace(0.0, 0.5 * np.pi, 101))
_SETTINGS = {"font.size": 9.0, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False}


def throw(spin: float) -> np.ndarray:
    """Velocity of a throw with a spin of `SPINS`, (3,) [m/s, m/s, rad/s]."""
    return SPEED * np.array([1.0, 0.0, spin / R])


def draw(variants: Sequence[Variant], path: Path) -> None:
    """Save the figure: limit surfaces, and distances that thrown objects slide.

    Args:
        variants: Rows of the table; those that are `drawn` are shown.
        path: Of a PNG file.

    Raises:
        RuntimeError: matplotlib or an engine is not installed.
    """
    matplotlib = library("matplotlib", "'slipgym[eval]'", "the figure")
    figures = library("matplotlib.figure", "'slipgym[eval]'", "the figure")
    shown = [variant for variant in variants if variant.drawn]
    with matplotlib.rc_context(_SETTINGS):
        figure = figures.Figure(figsize=(9.0, 4.0), layout="constrained")
        surface, distance = figure.subplots(1, 2)
        _draw_truth(surface, distance)
        for k, variant in enumerate(shown):
            look = {"color": COLOURS[k % len(COLOURS)], "marker": "osD^vP"[k % 6], "markersize": 4.5}
            name = f"{variant.engine}, {variant.settings}"
            friction = np.array([scenes.steady(variant, gamma)[0] for gamma in GAMMAS])
            f_t, torque = np.hypot(friction[:, 0], friction[:, 1]), np.abs(friction[:, 2])
            surface.plot(f_t, torque, linestyle="none", **look)
            slid = [scenes.slide(variant, SLIDING, throw(spin)) for spin in SPINS]
            distance.plot(SPINS, slid, linewidth=0.8, label=name, **look)
        distance.set_ylim(bottom=0.0)
        figure.legend(*distance.get_legend_handles_labels(), loc="outside lower center", ncols=3)
        figure.savefig(path, dpi=150)


def _draw_truth(surface: Any, distance: Any) -> None:
    """Axes, and the uniform disc's curves."""
    exact = np.abs([truth.friction(scenes.along(gamma)) for gamma in _CURVE])
    surface.plot(np.hypot(exact[:, 0], exact[:, 1]), exact[:, 2], "k-", linewidth=2.0)
    surface.plot([0.0, 1.0, 1.0], [1.0, 1.0, 0.0], color="0.6", linestyle=":")
    surface.text(0.99, 1.015, "decoupled", color="0.4", ha="right", va="bottom", fontsize=8.0)
    surface.set_xlabel("f_t / (mu Σf_n)")
    surface.set_ylabel("tau / (mu Σf_n r)")
    surface.set_title("Friction in steady slip and spin", loc="left")
    surface.set_aspect("equal")
    spins = np.linspace(SPINS[0], SPINS[-1], 25)
    slid = [1e3 * np.hypot(*truth.slide(SLIDING, throw(spin))[:2]) for spin in spins]
    distance.plot(spins, slid, "k-", linewidth=2.0, label="exact, uniform disc")
    distance.set_xlabel("spin r omega over sliding speed when thrown")
    distance.set_ylabel("distance slid [mm]")
    distance.set_title("A thrown object, until it rests", loc="left")
