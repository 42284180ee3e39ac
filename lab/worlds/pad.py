"""Divides a round pad into cells that share its normal force, for several pressures."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

RINGS, SECTORS = 6, 12
"""Of the disc and of Hertz's pressure: the limit surface is within 2 %."""
RIM = 16
"""Cells of the ring."""


class Pad(NamedTuple):
    """Cells of a pad of radius 1. The pad of the ellipsoid has none: its friction is one bristle of three."""

    places: NDArray[np.float64]
    """Of the cells, (m, 2) [-]."""
    weights: NDArray[np.float64]
    """Fractions of the normal force, (m,), sum 1 [-]."""
    areas: NDArray[np.float64]
    """Fractions of the area, (m,), sum 1 [-]."""
    ratio: float
    """Radius of the equivalent rim contact over that of the pad: the mean distance of the load [-]."""


@cache
def pad(shape: str) -> Pad:
    """The pad of a pressure.

    Args:
        shape: "disc", a uniform pressure; "hertz"; "ring", all load on the rim; "ellipsoid", without cells.

    Raises:
        ValueError: The shape is unknown.
    """
    if shape == "ellipsoid":
        return Pad(np.zeros((0, 2)), np.zeros(0), np.zeros(0), 1.0)
    if shape == "ring":
        return _cells(np.ones(1), np.ones(1), RIM)
    edges = np.sqrt(np.arange(RINGS + 1) / RINGS)
    if shape == "disc":
        load, moment = edges**2, 2.0 / 3.0 * edges**3
    elif shape == "hertz":  # integrals of the pressure 3/2 sqrt(1 - s^2) over 2 s ds and 2 s^2 ds
        fall = np.sqrt(1.0 - edges**2)
        load = 1.0 - fall**3
        moment = 3.0 / 8.0 * (np.arcsin(edges) - edges * fall * (1.0 - 2.0 * edges**2))
    else:
        raise ValueError(f"unknown shape {shape!r}; valid: disc, hertz, ring, ellipsoid")
    weights = np.diff(load)
    return _cells(np.diff(moment) / weights, weights, SECTORS)


def _cells(radii: NDArray[np.float64], weights: NDArray[np.float64], sectors: int) -> Pad:
    """Rings of equal area, each divided into equal sectors, turned by half a sector from ring to ring."""
    places = []
    for k, radius in enumerate(radii):
        angles = 2.0 * np.pi * (np.arange(sectors) + 0.5 * (1 + k % 2)) / sectors
        places.append(radius * np.column_stack((np.cos(angles), np.sin(angles))))
    m, every = sectors * len(radii), np.repeat(weights, sectors) / sectors
    return Pad(np.concatenate(places), every, np.full(m, 1.0 / m), float(radii @ weights))
