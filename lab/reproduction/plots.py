"""Figures of the coupling of mu_c and r."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from lab.reproduction.fixed_point import Slip, explicit_iteration, paper_map
from policies.evaluation.plots.style import STYLE

GAMMAS = (0.3, 0.5, 0.7, 0.9)
GAINS = (1.0, 0.8, 0.5, 0.2)


def plot_map() -> Figure:
    """The paper's map, and the estimator's explicit iteration for several gains."""
    figure = Figure(figsize=(9.0, 3.6))
    left, right = figure.subplots(1, 2)
    mu_c = np.linspace(0.1, 1.0, 200)
    for gamma_t, colour in zip(GAMMAS, STYLE.palette, strict=False):
        after = paper_map(Slip(gamma_t), mu_c)
        left.plot(mu_c, after, color=colour)
        left.annotate(f"$\\gamma_t$ {gamma_t:g}", (1.01, after[-1]), color=colour, va="center", size=8)
    left.plot(mu_c, mu_c, color=STYLE.muted, linestyle="--", linewidth=1)
    left.plot(0.4, 0.4, "o", color=STYLE.ink, markersize=4)
    left.annotate("true", (0.4, 0.4), (4, 8), textcoords="offset points", color=STYLE.ink, size=8)
    left.set(xlabel="μ$_c$ [–]", ylabel="T(μ$_c$) [–]", ylim=(0.0, 1.0), title="The paper's map contracts")
    for gain, colour in zip(GAINS, STYLE.palette, strict=False):
        radii = 1e3 * explicit_iteration(Slip(0.7), 0.020, gain, 12)
        right.plot(radii, "o-", color=colour, markersize=3, linewidth=1)
        right.annotate(f"κ {gain:g}", (1.15, radii[1]), color=colour, va="center", size=8)
    right.axhline(10.0, color=STYLE.muted, linestyle="--", linewidth=1)
    right.set(xlabel="step", ylabel="r [mm]", title="The explicit step oscillates at full gain")
    return figure


def plot_lock_out(
    maps: dict[tuple[str, float], np.ndarray], gammas: np.ndarray, radii: np.ndarray, tolerance: float
) -> Figure:
    """Where an estimator is still off after 3 s, over true gamma_t and start value r0.

    Args:
        maps: (estimator, normal force [N]) -> errors (k, m).
        gammas: (m,).
        radii: (k,) [m].
        tolerance: Error above which an estimate counts as off.
    """
    names, forces = (sorted({key[i] for key in maps}) for i in (0, 1))
    figure = Figure(figsize=(3.1 * len(forces) + 0.4, 2.3 * len(names) + 0.3))
    axes = figure.subplots(len(names), len(forces), squeeze=False, sharex=True, sharey=True)
    for (name, f_n), error in maps.items():
        ax = axes[names.index(name)][forces.index(f_n)]
        off = (error > tolerance).astype(float)
        ax.contourf(
            gammas,
            1e3 * radii,
            off,
            levels=[-0.5, 0.5, 1.5],
            colors=["white", STYLE.palette[1]],
            alpha=0.6,
        )
        ax.set_yscale("log")
        ax.axhline(10.0, color=STYLE.muted, linestyle="--", linewidth=1)
        ax.axhline(20.0, color=STYLE.ink, linewidth=1)
        ax.set_title(f"{name}, {f_n:g} N: {100 * off.mean():.0f} % still off")
    for ax in axes[-1]:
        ax.set_xlabel("true γ$_t$ [–]")
    for row in axes:
        row[0].set_ylabel("start value r$_0$ [mm]")
    axes[0][-1].annotate("Table 1: 20 mm", (gammas[0], 21.5), size=7.5, color=STYLE.ink)
    axes[0][-1].annotate("true: 10 mm", (gammas[0], 10.6), size=7.5, color=STYLE.muted)
    return figure
