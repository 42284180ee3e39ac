"""Builds shapes from triangles, and the object as what it stands for: a box, a bottle, a tool.

The drawn body lies within the box that is simulated, and has its thickness along the grip axis. Pads and
friction know nothing of it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from slipgym.world.scene import Box

Triangles = NDArray[np.float64]
"""(n, 3, 3): triangle, corner, coordinate (x, y, z) [m]."""
Shade = tuple[float, float, float]
Part = tuple[Triangles, Shade]

_SIDES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


class Section(NamedTuple):
    """A part of a body along its axis, between two cuts."""

    ends: tuple[float, float]
    """Where it begins and ends, of the half length, -1 to 1."""
    widths: tuple[float, float]
    """Its half width there, of that of the box."""
    shade: float
    """Ratio of its brightness to the material's; 0: dark metal."""


BODIES: dict[str, tuple[Section, ...]] = {
    "box": (Section((-1.0, 1.0), (1.0, 1.0), 1.0),),
    "bottle": (
        Section((-1.0, -0.96), (0.9, 1.0), 1.0),
        Section((-0.96, 0.42), (1.0, 1.0), 1.0),
        Section((0.42, 0.66), (1.0, 0.42), 0.96),
        Section((0.66, 0.80), (0.42, 0.36), 0.96),
        Section((0.80, 1.0), (0.44, 0.44), 0.6),
    ),
    "tool": (
        Section((-1.0, -0.4), (0.8, 0.8), 1.0),
        Section((-0.4, -0.3), (0.8, 0.5), 0.9),
        Section((-0.3, 0.84), (0.5, 0.5), 0.0),
        Section((0.84, 1.0), (1.0, 1.0), 0.0),
    ),
}
"""Name -> its sections, from the bottom up or from the end that is grasped; the longest one has the print."""
_BASE: dict[str, Shade] = {
    "wood": (0.79, 0.60, 0.39),
    "case": (0.38, 0.49, 0.60),
    "plastic": (0.72, 0.64, 0.80),
    "cardboard": (0.85, 0.76, 0.59),
}
"""Colour by the material's name."""
_OTHER: Shade = (0.60, 0.69, 0.58)
_METAL: Shade = (0.55, 0.58, 0.62)


def draw_body(name: str, box: Box, material: str, face: float) -> list[Part]:
    """Parts of a body of `BODIES` in the simulated box, from the geometric centre of the box.

    A tool lies along the longer side of the box and is grasped by its handle. What is printed on the broad
    face that is seen has y = face [m].
    """
    lying = name == "tool" and box.size[0] > box.size[2]
    length, width = (box.size[0], box.size[2]) if lying else (box.size[2], box.size[0])
    turned = name == "tool" and box.grasp_offset[0 if lying else 1] > 0.0
    base = np.array(_BASE.get(material, _OTHER))
    sections, parts = BODIES[name], []
    for section in sections:
        along, across = 0.5 * length * np.array(section.ends), 0.5 * width * np.array(section.widths)
        shape = frustum(along, across, 0.5 * box.size[1])
        red, green, blue = (base * section.shade if section.shade else np.array(_METAL)).tolist()
        parts.append((_placed(shape, lying, turned), (red, green, blue)))
    main = max(sections, key=lambda section: section.ends[1] - section.ends[0])
    if main.shade:
        low, high = main.ends
        half = 0.5 * width * min(main.widths), 0.25 * length * (high - low)
        shift = np.array([0.0, 0.0, 0.25 * length * (high + low)])
        for shape, shade in _PRINTS[material](half, face) if material in _PRINTS else ():
            parts.append((_placed(shape + shift, lying, turned), shade))
    return parts


def _placed(shape: Triangles, lying: bool, turned: bool) -> Triangles:
    """A shape along z as the body lies in the box: turned about the grip axis, so it still faces outside."""
    if turned:
        shape = shape * (-1.0, 1.0, -1.0)
    return shape[..., [2, 1, 0]] * (1.0, 1.0, -1.0) if lying else shape


def _darker(material: str, fraction: float) -> Shade:
    red, green, blue = (fraction * part for part in _BASE[material])
    return red, green, blue


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
        patch((-half[0], half[0]), (z - 3e-4, z + 3e-4), face)
        for z in np.arange(-half[1] + 0.004, half[1], 0.004)
    ]
    tape = patch((-0.3 * half[0], 0.3 * half[0]), (-half[1], half[1]), face - 5e-5)
    return [(np.concatenate(flutes), _darker("cardboard", 0.95)), (tape, (0.92, 0.86, 0.73))]


def _plastic(half: tuple[float, float], face: float) -> list[Part]:
    """Two streaks of light aslant."""
    parts: list[Part] = []
    z, lean = np.array([-half[1], half[1]]), 0.35 * half[0] * np.array([-1.0, 1.0])
    for at, thick in ((-0.35, 0.14), (0.02, 0.05)):
        parts.append((_band(at * half[0] + lean, z, thick * half[0], face), (0.82, 0.76, 0.88)))
    return parts


def _case(half: tuple[float, float], face: float) -> list[Part]:
    """A recessed rim."""
    edge, line = 0.12 * min(half), 0.02 * min(half)
    (x, z), (across, along) = (half[0] - edge, half[1] - edge), (half[0] - edge - line, half[1] - edge - line)
    field = patch((-across, across), (-along, along), face - 5e-5)
    return [(patch((-x, x), (-z, z), face), _darker("case", 0.72)), (field, (0.43, 0.55, 0.66))]


def _band(x: np.ndarray, z: np.ndarray, thick: float, y: float) -> Triangles:
    """A band around a line x(z) in the plane of that y, seen from -y."""
    left, right = (np.column_stack([x + d, np.full_like(z, y), z]) for d in (-thick, thick))
    corners = zip(left, right, right[1:], left[1:], strict=False)
    return np.concatenate([quad(np.array(each)) for each in corners])


_PRINTS = {"wood": _wood, "case": _case, "plastic": _plastic, "cardboard": _cardboard}


def quad(corners: np.ndarray) -> Triangles:
    """A flat four-sided face, corners (4, 3)."""
    return np.stack([corners[[0, 1, 2]], corners[[0, 2, 3]]])


def box(half: tuple[float, float, float], centre: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Triangles:
    """An upright box by its half extents."""
    x, y, z = half
    return frustum(np.array([-z, z]), np.array([x, x]), y) + np.asarray(centre)


def frustum(along: np.ndarray, across: np.ndarray, thick: float) -> Triangles:
    """A solid along z, symmetric in x: two ends, lower first, and half widths there (2,), half depth [m]."""
    ends = list(zip(across, along, strict=True))
    corners = np.array([(sign * x, y, z) for sign in (-1, 1) for y in (-thick, thick) for x, z in ends])
    return np.concatenate([quad(corners[list(side)]) for side in _SIDES])


def disc(radius: float, y: float, sides: int = 24) -> Triangles:
    """A disc in the plane of that y, seen from -y."""
    angles = 2.0 * math.pi * np.arange(sides) / sides
    rim = np.column_stack([radius * np.cos(angles), np.full(sides, y), radius * np.sin(angles)])
    centre = np.broadcast_to([0.0, y, 0.0], rim.shape)
    return np.stack([centre, rim, np.roll(rim, -1, axis=0)], axis=1)


def cylinder(radius: float, length: float, sides: int = 24) -> Triangles:
    """A cylinder around the y axis, its middle at the origin."""
    front = disc(radius, -length / 2, sides)
    back = disc(radius, length / 2, sides)[:, ::-1]
    here, there = front[:, 1], front[:, 2]
    along = np.array([0.0, length, 0.0])
    left = np.stack([there, here, here + along], axis=1)
    right = np.stack([there, here + along, there + along], axis=1)
    return np.concatenate([front, back, left, right])


def patch(x: tuple[float, float], z: tuple[float, float], y: float) -> Triangles:
    """A rectangle in the plane of that y, seen from -y."""
    return quad(np.array([(x[0], y, z[0]), (x[1], y, z[0]), (x[1], y, z[1]), (x[0], y, z[1])]))
