"""Anisotropic friction of a pad: larger along its x, smaller along its y."""

from __future__ import annotations

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact.records import Cells, X, Y


@compiled
def stretch(cells: Cells, axes: np.ndarray) -> None:
    """Stretch the cells (CELL_FIELDS, m) of an anisotropic pad by its `axes` (2,).

    A scaled displacement along x changes with the position along y, and the other way round.
    """
    for i in range(cells.shape[1]):
        cells[X, i] *= axes[1]
        cells[Y, i] *= axes[0]


@compiled
def friction_axes(anisotropy: float) -> tuple[float, float]:
    """Friction along a pad's x and y over its mean [-]."""
    return 1.0 + anisotropy, 1.0 - anisotropy
