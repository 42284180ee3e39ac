"""State of the pads as plain arrays: the records that the contact kernels read and write."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from slipgym._numba.compiled import compiled

PAD = np.dtype(
    [
        ("mu_c", "f8"),  # Coulomb friction [-]
        ("mu_s", "f8"),  # static friction [-]
        ("stribeck_velocity", "f8"),  # v_s [m/s]
        ("stribeck_exponent", "f8"),  # gamma [-]
        ("sigma_0", "f8"),  # bristle stiffness per normal force [1/m]
        ("sigma_1", "f8"),  # bristle damping per normal force [s/m]
        ("sigma_2", "f8"),  # viscous friction per normal force [s/m]
        ("r", "f8"),  # radius of the equivalent rim contact; a patch's unit of length [m]
        ("cop", "f8", 2),  # centre of pressure in the pad frame [m]
        ("z", "f8", 3),  # bristle state in the scaled displacement (x, y, r theta) [m]
        ("slip_speed", "f8"),  # scaled slip speed; does not rise in stick [m/s]
        ("slip_rate", "f8"),  # its rate of change [m/s^2]
        ("half_step", "f8"),  # half of the last sub-step: speed and twist are means, those of its middle [s]
        ("twist", "f8", 3),  # scaled slip twist of a patch [m/s]
        ("twist_rate", "f8", 3),  # its rate of change [m/s^2]
        ("normal", "f8"),  # normal force [N]
        ("wrench", "f8", 3),  # on the object at the centre of pressure, pad frame [N, N, N m]
    ]
)
"""One pad: parameters of the limit surface, bristle state and last wrench."""

Pad: TypeAlias = Any
"""A record of `PAD`. Compiled code reads its fields as attributes, which numpy's types do not describe."""
Pads: TypeAlias = Any
"""Records of `PAD`, as an array or as a tuple."""
Cells: TypeAlias = np.ndarray
"""Cells of one pad's patch, (CELL_FIELDS, n)."""
Vector: TypeAlias = tuple[float, float, float]
"""A scaled vector (x, y, r theta), or a motion (x, y, theta)."""
Symmetric: TypeAlias = tuple[float, float, float, float, float, float]
"""A symmetric 3 x 3 matrix (xx, yy, tt, xy, xt, yt)."""

X, Y = 0, 1
"""Position of a cell from the centre of pressure over the pad's r [-]."""
LOAD = 2
"""Fraction of the pad's normal force that a cell carries [-]."""
Z_X, Z_Y = 3, 4
"""Bristle state of a cell [m]."""
SPEED_CAP = 5
"""Slip speed of a cell that stick does not exceed; infinite in slip [m/s]."""
ELASTIC_LIMIT = 6
"""Longest deflection of a cell's bristle in this step [m]."""
RETENTION = 7
"""Fraction of its deflection that a cell's bristle has kept in this step's friction level [-]."""
CELL_FIELDS = 8
"""Rows of a patch, an array (CELL_FIELDS, n): one quantity in a row lets loops over n cells vectorise."""


def pads(shape: int | tuple[int, ...], **parameters: float) -> np.ndarray:
    """Return an array of pads at rest, Stribeck exponent 2 unless given.

    Args:
        shape: Shape of the array.
        **parameters: Values of the parameter fields of `PAD`, broadcast over the array.
    """
    array = np.zeros(shape, PAD)
    for name, value in {"stribeck_exponent": 2.0, **parameters}.items():
        array[name] = value
    return array


def patch(positions: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Return cells at rest, shape (CELL_FIELDS, n).

    Args:
        positions: From the centre of pressure, over the pad's r, shape (n, 2) [-].
        loads: Fractions of the normal force, shape (n,), sum 1.
    """
    cells = np.zeros((CELL_FIELDS, len(loads)))
    cells[X], cells[Y] = positions.T
    cells[LOAD] = loads
    cells[RETENTION] = 1.0
    return cells


@compiled
def rest(pads: np.ndarray) -> None:
    """Bring pads, an array (n,) of `PAD`, to rest: no deflection, no speed, no wrench."""
    for i in range(pads.shape[0]):
        pad = pads[i]
        pad.z[:] = 0.0
        pad.slip_speed = pad.slip_rate = pad.half_step = 0.0
        pad.twist[:] = 0.0
        pad.twist_rate[:] = 0.0
        pad.wrench[:] = 0.0


@compiled
def rest_cells(cells: np.ndarray) -> None:
    """Bring cells (..., CELL_FIELDS, n) to rest: no deflection, no speed."""
    for row in (Z_X, Z_Y, SPEED_CAP):
        cells[..., row, :] = 0.0
    cells[..., RETENTION, :] = 1.0
