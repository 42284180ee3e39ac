"""Draws the object as what it stands for: a box, a bottle, a tool.

The drawn body lies within the box that is simulated, and has its thickness along the grip axis. Pads and
friction know nothing of it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from slipgym.rendering import materials, solids
from slipgym.rendering.materials import Part, Shade
from slipgym.world.scene import Box


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
_METAL: Shade = (0.55, 0.58, 0.62)


def draw_body(name: str, box: Box, material: str, face: float) -> list[Part]:
    """Parts of a body, from the geometric centre of the box.

    Args:
        name: One of `BODIES`. A tool lies along the longer side of the box and is grasped by its handle.
        box: The simulated object.
        material: Name of its material.
        face: y of what is printed on the broad face that is seen [m].
    """
    lying = name == "tool" and box.size[0] > box.size[2]
    length, width = (box.size[0], box.size[2]) if lying else (box.size[2], box.size[0])
    grasp = box.grasp_offset[0 if lying else 1]
    turned = name == "tool" and grasp > 0.0
    base = np.array(materials.BASE.get(material, materials.OTHER))
    sections, parts = BODIES[name], []
    for section in sections:
        along = 0.5 * length * np.array(section.ends)
        across = 0.5 * width * np.array(section.widths)
        shape = solids.frustum(along, across, 0.5 * box.size[1])
        red, green, blue = (base * section.shade if section.shade else np.array(_METAL)).tolist()
        parts.append((_placed(shape, lying, turned), (red, green, blue)))
    main = max(sections, key=lambda section: section.ends[1] - section.ends[0])
    if main.shade:
        extent = 0.5 * length * (main.ends[1] - main.ends[0])
        middle = 0.25 * length * (main.ends[1] + main.ends[0])
        half_box = replace(box, size=(width * min(main.widths), box.size[1], extent))
        printed = materials.printed(material, half_box, face)
        shift = np.array([0.0, 0.0, middle])
        parts += [(_placed(shape + shift, lying, turned), shade) for shape, shade in printed]
    return parts


def _placed(shape: solids.Triangles, lying: bool, turned: bool) -> solids.Triangles:
    """A shape along z as the body lies in the box: turned about the grip axis, so it still faces outside."""
    if turned:
        shape = shape * (-1.0, 1.0, -1.0)
    return shape[..., [2, 1, 0]] * (1.0, 1.0, -1.0) if lying else shape
