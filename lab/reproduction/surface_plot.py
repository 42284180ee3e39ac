"""Figure of the limit surfaces and of the ellipsoid's bias."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lab.limit_surface_exact import exact_friction
from lab.reproduction.fixed_point import disc_bias
from lab.validation.patch_surface import MU_C, RADIUS, steady_friction, surface_twists
from policies.evaluation.plots.style import STYLE, note
from slipgym.contact import DistributedContact
from slipgym.contact.pressure import OUTER_RADII

CELLS = 21
MARKS = {"uniform": "o", "hertz": "D", "rim": "s"}


def plot_surface(gammas: Sequence[float]) -> Figure:
    """Limit surfaces on the left, bias of the ellipsoid's equations on a uniform disc on the right.

    Args:
        gammas: Shares of translation at which the two are joined, on the left.
    """
    figure = Figure(figsize=(9.0, 4.4))
    left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    _surfaces(left, gammas)
    _bias(right)
    return figure


def _surfaces(ax: Axes, gammas: Sequence[float]) -> None:
    dense, few = surface_twists(721, 1), surface_twists(19, 1)
    ax.plot(dense[:, 0], dense[:, 2], "--", color=STYLE.muted, label="ellipsoid")
    for name, colour in zip(MARKS, STYLE.palette, strict=False):
        scale = 1.0, 1.0, OUTER_RADII[name]
        curve = -exact_friction(name, dense * scale) * scale
        ax.plot(curve[:, 0], curve[:, 2], color=colour, label=f"{name}, exact")
        contact = DistributedContact(RADIUS, CELLS, name, MU_C, MU_C, sigma_2=0.0)
        points = -steady_friction(contact, few)
        ax.plot(
            points[:, 0], points[:, 2], MARKS[name], color=colour, markersize=4, mfc="white", clip_on=False
        )
    for gamma_t in gammas:
        slip = np.array([[gamma_t, 0.0, np.sqrt(1.0 - gamma_t**2)]])
        disc = -exact_friction("uniform", slip * (1.0, 1.0, 1.5)) * (1.0, 1.0, 1.5)
        ax.plot([gamma_t, disc[0, 0]], [slip[0, 2], disc[0, 2]], color=STYLE.muted, linewidth=0.8)
        ax.plot(gamma_t, slip[0, 2], ".", color=STYLE.muted)
        note(ax, gamma_t + 0.015, float(slip[0, 2]) + 0.012, f"γ$_t$ {gamma_t:g}", STYLE.muted)
    ax.plot(
        [], [], "o", color=STYLE.ink, markersize=4, mfc="white", label=f"{CELLS} × {CELLS} cells, simulated"
    )
    ax.set(xlabel="f$_t$ / (μ$_c$ f$_n$) [–]", ylabel="τ / (μ$_c$ f$_n$ r) [–]", aspect="equal")
    ax.set(xlim=(0.0, 1.1), ylim=(0.0, 1.1), title="Limit surfaces of a disc")
    ax.legend(loc="lower left")


def _bias(ax: Axes) -> None:
    gammas = np.linspace(0.02, 0.98, 193)
    errors = 100.0 * np.array([disc_bias(float(gamma_t)) for gamma_t in gammas])
    ax.axhline(0.0, color=STYLE.muted, linewidth=0.8)
    for values, name, colour in zip(errors.T, ("μ$_c$", "r"), STYLE.palette, strict=False):
        ax.plot(gammas, values, color=colour)
        note(ax, 0.06, float(values[8]) - 3.0, name, colour)
    ax.set(xlabel="γ$_t$ at the true r [–]", ylabel="error of the ellipsoid [%]", xlim=(0.0, 1.0))
    ax.set_title("Estimated with the ellipsoid on a uniform disc")
