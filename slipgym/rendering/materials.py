"""Defines the appearance of the object's materials: a colour, and a pattern on the two broad faces."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from slipgym.rendering import solids
from slipgym.world.scene import Box

Shade = tuple[float, float, float]
Part = tuple[solids.Triangles, Shade]

BASE: dict[str, Shade] = {
    "wood": (0.79, 0.60, 0.39),
    "case": (0.38, 0.49, 0.60),
    "plastic": (0.72, 0.64, 0.80),
    "cardboard": (0.85, 0.76, 0.59),
}
"""Colour by the material's name."""
OTHER: Shade = (0.60, 0.69, 0.58)


def printed(material: str, box: Box, face: float) -> list[Part]:
    """The pattern on the broad face at that y; empty for a material without a pattern."""
    half = box.size[0] / 2, box.size[2] / 2
    return _PRINTS[material](half, face) if material in _PRINTS else []


def _darker(material: str, fraction: float) -> Shade:
    red, green, blue = BASE[material]
    return fraction * red, fraction * green, fraction * blue


def _wood(half: tuple[float, float], face: float) -> list[Part]:
    """Grain along z."""
    z = np.linspace(-half[1], half[1], 25)
    parts = []
    for k, at in enumerate(np.linspace(-0.92, 0.92, 13)):
        wave = 0.02 * np.sin(9.0 * z / half[1] * (0.3 + 0.05 * (k % 5)) + 1.7 * k)
        x = half[0] * (at + wave)
        thick = half[0] * (0.007 + 0.006 * math.sin(2.4 * k) ** 2)
        parts.append((_band(x, z, thick, face), _darker("wood", 0.84 + 0.05 * (k % 3))))
    return parts


def _cardboard(half: tuple[float, float], face: float) -> list[Part]:
    """Flutes across, and a tape along the middle."""
    flutes = [
        solids.patch((-half[0], half[0]), (z - 3e-4, z + 3e-4), face)
        for z in np.arange(-half[1] + 0.004, half[1], 0.004)
    ]
    tape = solids.patch((-0.3 * half[0], 0.3 * half[0]), (-half[1], half[1]), face - 5e-5)
    return [(np.concatenate(flutes), _darker("cardboard", 0.95)), (tape, (0.92, 0.86, 0.73))]


def _plastic(half: tuple[float, float], face: float) -> list[Part]:
    """Two streaks of light aslant."""
    parts = []
    for at, thick in ((-0.35, 0.14), (0.02, 0.05)):
        lean = 0.35 * half[0]
        x = np.array([at * half[0] - lean, at * half[0] + lean])
        parts.append((_band(x, np.array([-half[1], half[1]]), thick * half[0], face), (0.82, 0.76, 0.88)))
    return parts


def _case(half: tuple[float, float], face: float) -> list[Part]:
    """A recessed rim."""
    edge, line = 0.12 * min(half), 0.02 * min(half)
    outer, inner = (half[0] - edge, half[1] - edge), (half[0] - edge - line, half[1] - edge - line)
    rim = solids.patch((-outer[0], outer[0]), (-outer[1], outer[1]), face)
    field = solids.patch((-inner[0], inner[0]), (-inner[1], inner[1]), face - 5e-5)
    return [(rim, _darker("case", 0.72)), (field, (0.43, 0.55, 0.66))]


def _band(x: np.ndarray, z: np.ndarray, thick: float, y: float) -> solids.Triangles:
    """A band around a line x(z) in the plane of that y, seen from -y."""
    left, right = (np.column_stack([x + d, np.full_like(z, y), z]) for d in (-thick, thick))
    pieces = [
        solids.quad(np.array([left[k], right[k], right[k + 1], left[k + 1]])) for k in range(len(z) - 1)
    ]
    return np.concatenate(pieces)


_PRINTS: dict[str, Callable[[tuple[float, float], float], list[Part]]] = {
    "wood": _wood,
    "case": _case,
    "plastic": _plastic,
    "cardboard": _cardboard,
}
