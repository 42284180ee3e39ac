"""Drawn bodies lie within the simulated box, are closed, and face outside."""

import numpy as np
import pytest

from slipgym.rendering.bodies import BODIES, draw_body
from slipgym.world.scene import Box

SIZES = {"standing": (0.05, 0.03, 0.25), "lying": (0.46, 0.03, 0.04)}


def drawn(name, size, grasp=(0.0, 0.0)):
    box = Box(size, (0.0, 0.0), grasp, 0.2, 1e-3)
    return [shape for shape, _ in draw_body(name, box, "without a print", -0.0152)]


def volume(triangles):
    """By the divergence theorem: positive if the triangles face outside."""
    return np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6.0


@pytest.mark.parametrize("size", SIZES.values(), ids=list(SIZES))
@pytest.mark.parametrize("name", BODIES)
def test_a_body_fills_its_box(name, size):
    parts = drawn(name, size)
    corners = np.concatenate(parts).reshape(-1, 3)
    np.testing.assert_allclose(np.abs(corners).max(axis=0), 0.5 * np.array(size), rtol=1e-12)
    for part in parts:
        assert volume(part) > 0.0
    assert sum(map(volume, parts)) <= np.prod(size) * (1.0 + 1e-12)


@pytest.mark.parametrize(
    ("size", "grasp", "axis"), [((0.05, 0.03, 0.25), (0.0, 0.1), 2), ((0.46, 0.03, 0.04), (-0.18, 0.0), 0)]
)
def test_a_tool_is_grasped_by_its_handle(size, grasp, axis):
    handle = drawn("tool", size, grasp)[0].reshape(-1, 3)[:, axis]
    held = grasp[0 if axis == 0 else 1]
    assert handle.min() - 1e-12 <= held <= handle.max() + 1e-12


def test_a_print_lies_on_the_longest_section():
    box = Box((0.08, 0.03, 0.16), (0.0, 0.0), (0.0, 0.0), 0.2, 1e-3)
    printed = draw_body("bottle", box, "cardboard", -0.0152)[len(BODIES["bottle"]) :]
    assert printed
    heights = np.concatenate([shape for shape, _ in printed])[..., 2]
    assert heights.min() >= -0.08
    assert heights.max() <= 0.42 * 0.08 + 1e-12
