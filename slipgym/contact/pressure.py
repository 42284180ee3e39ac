"""Discretises the pressure of a round patch into load fractions of the cells of a square grid.

A named pressure is sampled at points of equal load, on RINGS circles with SECTORS points each. A
cell's load fraction is the fraction of the points in it, and its position is their mean. The centre,
total and outline of the pressure are therefore those of the disc: a cell cut by the rim has the load
and the position of its part inside. Counting points leaves an error of 0.5 % of a whole cell's load
(against exact areas).

The mean of a cell's points lies nearer to the centre than the points do on average, which makes the
torque in spin too small, at 21 x 21 cells by 0.1 to 0.2 %. All positions are therefore multiplied by
one factor that makes it exact. The remaining error of the limit surface is mostly that of the cell
in which the centre of rotation lies.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from slipgym._numba.compiled import compiled
from slipgym.contact.records import Cells, X, Y

RINGS = 400
SECTORS = 2000  # a multiple of 8: points have the symmetry of the grid
MAX_CELLS = 201

PressureName: TypeAlias = Literal["uniform", "hertz", "rim", "punch"]
"""Names of `PRESSURES`, for the configuration."""


class Pressure(NamedTuple):
    """A pressure over a round patch."""

    quantile: Callable[[np.ndarray], np.ndarray]
    """Radius inside which a fraction of the load lies, of a disc of radius 1."""
    outer_radius: float
    """Radius of the disc over that of the equivalent rim contact, exactly [-]."""


PRESSURES: dict[PressureName, Pressure] = {
    "uniform": Pressure(np.sqrt, 1.5),
    "hertz": Pressure(lambda load: np.sqrt(1.0 - (1.0 - load) ** (2.0 / 3.0)), 16.0 / (3.0 * np.pi)),
    "rim": Pressure(np.ones_like, 1.0),
    "punch": Pressure(lambda load: np.sqrt(load * (2.0 - load)), 4.0 / np.pi),
}
"""Name -> pressure: constant, proportional to sqrt(1 - rho^2) (Hertz), on the edge alone, or proportional to
1 / sqrt(1 - rho^2), higher towards the edge: a flat rigid pad (Johnson, Contact Mechanics, 1985, 3.4)."""
OUTER_RADII: dict[str, float] = {name: pressure.outer_radius for name, pressure in PRESSURES.items()}
"""Name -> `Pressure.outer_radius`."""


def patch_cells(pressure: str | ArrayLike, cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Positions and load fractions of the cells that carry load.

    Args:
        pressure: A name of `PRESSURES`, or relative loads of the cells, shape (cells, cells),
            >= 0, any unit: element (i, j) belongs to the i-th column along x and the j-th row
            along y, and acts at its middle. Loads are taken as they are, in the whole square.
        cells: Cells along either side.

    Returns:
        Positions relative to the centre of pressure over the radius of the disc, half the side
        of the square, shape (n, 2); fractions of the normal force, shape (n,), sum 1.

    Raises:
        ValueError: An unknown name, or an array of another shape, with a value that is
            negative or not finite, or without load.
    """
    if isinstance(pressure, str):
        loads, moments = _sampled(pressure, cells)
    else:
        loads, moments = _given(np.asarray(pressure, dtype=float), cells)
    loaded = loads > 0.0
    fractions = loads[loaded] / loads.sum()
    positions = moments[loaded] / loads[loaded, None]
    positions -= fractions @ positions
    if isinstance(pressure, str) and len(fractions) > 1:
        positions /= OUTER_RADII[pressure] * (fractions @ np.hypot(*positions.T))
    return positions, fractions


def _sampled(name: str, cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Loads (cells^2,) and first moments (cells^2, 2) of a named pressure on the unit disc."""
    quantile = {known: pressure.quantile for known, pressure in PRESSURES.items()}.get(name)
    if quantile is None:
        raise ValueError(f"pressure = {name!r} must be a ({cells}, {cells}) array or one of {_names()}")
    rho = quantile((np.arange(RINGS) + 0.5) / RINGS)
    angle = 2.0 * np.pi * (np.arange(SECTORS) + 0.5) / SECTORS
    points = np.stack([np.outer(rho, np.cos(angle)).ravel(), np.outer(rho, np.sin(angle)).ravel()])
    column, row = np.floor(0.5 * cells * (points + 1.0)).astype(int)
    index = column * cells + row
    moments = np.stack([np.bincount(index, axis, cells * cells) for axis in points], axis=1)
    return np.bincount(index, minlength=cells * cells).astype(float), moments


def _given(loads: np.ndarray, cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Loads (cells^2,) and first moments (cells^2, 2) of given loads on the square of side 2."""
    if loads.shape != (cells, cells):
        raise ValueError(
            f"pressure must have shape ({cells}, {cells}) or be one of {_names()}, got {loads.shape}"
        )
    if not np.all(np.isfinite(loads)) or loads.min() < 0.0 or loads.max() == 0.0:
        raise ValueError(
            f"pressure must be finite, >= 0 and somewhere > 0, got values from {loads.min()} to {loads.max()}"
        )
    middle = (2.0 * np.arange(cells) + 1.0) / cells - 1.0
    centres = np.stack(np.meshgrid(middle, middle, indexing="ij"), axis=-1).reshape(-1, 2)
    flat = loads.ravel() / loads.max()
    return flat, flat[:, None] * centres


def _names() -> str:
    return ", ".join(map(repr, PRESSURES))


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
