"""The supports of the block: where its load acts, and their exact limit surface.

Lengths are in the frame of the supports, whose axes are the legs of the triangular block. The centre of mass
is that of the triangle. Without further points than three the loads follow from the balance of forces and
moments; the whole underside is taken as loaded evenly.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from slipgym.contact.limit_surface import LimitSurface

LEG = 0.150
"""Legs of the triangular block [m]."""
CENTRE = np.full(2, LEG / 3.0)
"""Centre of mass [m]."""
WEIGHT = 1.518 * 9.81
"""Normal force, of a block of 1.518 kg [N]."""
FEET = {
    "large": ((10.0, 130.0, 10.0), (10.0, 10.0, 130.0)),
    "wide": ((10.0, 90.0, 10.0), (10.0, 30.0, 130.0)),
    "small": ((30.0, 90.0, 30.0), (30.0, 30.0, 90.0)),
    "tiny": ((30.0, 63.33, 43.33), (30.0, 43.33, 63.33)),
}
"""Support -> x and y of its three feet [mm], as the folder of its log is named."""
PATCH = "patch"
"""The support that is the whole underside."""
DIVISIONS = 40
"""The patch is divided into the square of this number of equal triangles."""


def points(support: str) -> tuple[np.ndarray, np.ndarray]:
    """Where the load acts.

    Args:
        support: A key of `FEET`, or `PATCH`.

    Returns:
        Positions from the centre of mass, (n, 2) [m]; fractions of the weight, (n,), sum 1.

    Raises:
        ValueError: The support is unknown.
    """
    if support == PATCH:
        positions = _triangles() * LEG - CENTRE
        return positions, np.full(len(positions), 1.0 / len(positions))
    if support not in FEET:
        raise ValueError(f"unknown support {support!r}; valid: {', '.join((*FEET, PATCH))}")
    positions = 1e-3 * np.array(FEET[support]).T - CENTRE
    balance = np.vstack((np.ones(3), positions.T))  # sum of loads, and their moments about the centre of mass
    return positions, np.linalg.solve(balance, [1.0, 0.0, 0.0])


def _triangles() -> np.ndarray:
    """Centroids of equal triangles that make up the right triangle with legs of 1, (n^2, 2)."""
    i, j = np.meshgrid(np.arange(DIVISIONS), np.arange(DIVISIONS), indexing="ij")
    upright, upside = i + j < DIVISIONS, i + j < DIVISIONS - 1
    corners = [
        np.column_stack((i[which], j[which])) + third
        for which, third in ((upright, 1.0 / 3.0), (upside, 2.0 / 3.0))
    ]
    return np.vstack(corners) / DIVISIONS


@cache
def surface(support: str) -> LimitSurface:
    """The exact limit surface of a support; arguments and errors as `points`."""
    return LimitSurface(*points(support))


def mean_path(support: str, displacements: np.ndarray) -> np.ndarray:
    """Mean path of the load: friction work over mu_c and the weight.

    Args:
        support: As of `points`.
        displacements: (d_x, d_y, d_theta) about the centre of mass, (n, 3) [m, m, rad].

    Returns:
        Shape (n,) [m].
    """
    positions, shares = points(support)
    x, y = positions.T
    d_x, d_y, d_theta = (column[:, None] for column in displacements.T)
    return np.hypot(d_x - d_theta * y, d_y + d_theta * x) @ shares
