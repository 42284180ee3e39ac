"""Lines, triangles, words and plots do what they say."""

import numpy as np
import pytest

from policies.evaluation.plots.style import STYLE
from slipgym.rendering import palette
from slipgym.rendering.plot import limits, spacing
from slipgym.rendering.raster import fill, stroke
from slipgym.rendering.text import write


def test_two_triangles_fill_a_square_once():
    image, nearness = np.zeros((40, 40, 3), np.uint8), np.zeros((40, 40), np.float32)
    a, b, c, d = (5.2, 6.3, 1.0), (30.2, 6.3, 1.0), (30.2, 33.7, 1.0), (5.2, 33.7, 1.0)
    colours = np.array([[200.0, 100.0, 50.0, 0.5]] * 4)
    fill(np.array([[a, c, b], [a, d, c], [a, b, c], [a, c, d]]), colours, image, nearness)
    expected = np.zeros((40, 40), bool)
    expected[6:34, 5:30] = True
    np.testing.assert_array_equal(image[..., 0] == 100, expected)
    assert set(np.unique(image[..., 0])) == {0, 100}


def test_the_nearer_triangle_hides_the_farther():
    rng = np.random.default_rng(0)
    corners = np.concatenate(
        [rng.uniform(-10.0, 50.0, (60, 3, 2)), rng.uniform(0.5, 2.0, (60, 3, 1))], axis=-1
    )
    colours = np.column_stack([rng.integers(1, 255, (60, 3)), np.ones(60)]).astype(float)
    images = []
    for order in (np.arange(60), rng.permutation(60)):
        image, nearness = np.zeros((40, 40, 3), np.uint8), np.zeros((40, 40))
        fill(corners[order], colours[order], image, nearness)
        images.append(image)
    np.testing.assert_array_equal(*images)


@pytest.mark.parametrize("slope", [0.0, 0.3, 1.0, 4.0, 1e9])
def test_a_line_covers_length_times_width(slope):
    along = np.array([1.0, slope]) / np.hypot(1.0, slope)
    mask = np.zeros((100, 100))
    stroke(np.stack([50.0 - 30.0 * along, 50.0 + 30.0 * along]), 4.0, 0.0, mask)
    assert mask.sum() == pytest.approx(60.0 * 4.0 + np.pi * 4.0, rel=0.02)


def test_a_line_breaks_where_there_is_nothing():
    points = np.array([[5.0, 10.0], [15.0, 10.0], [np.nan, np.nan], [25.0, 10.0], [35.0, 10.0]])
    mask = np.zeros((20, 40))
    stroke(points, 2.0, 0.0, mask)
    assert mask[10, 10] == mask[10, 30] == 1.0
    assert mask[10, 20] == 0.0


def test_dashes_cover_half():
    masks = np.zeros((2, 20, 200))
    for mask, dash in zip(masks, (0.0, 5.0), strict=True):
        stroke(np.array([[10.0, 10.0], [190.0, 10.0]]), 2.0, dash, mask)
    assert masks[1].sum() == pytest.approx(0.5 * masks[0].sum(), rel=0.05)


@pytest.mark.parametrize("align", [0.0, 0.5, 1.0])
def test_words_stand_where_they_are_put(align):
    picture = np.full((40, 200, 3), 255, np.uint8)
    write(picture, 100, 30, "grip", palette.INK, 13, align)
    columns = np.flatnonzero((picture < 200).any(axis=(0, 2)))
    rows = np.flatnonzero((picture < 200).any(axis=(1, 2)))
    width = columns.max() - columns.min()
    assert columns.min() == pytest.approx(100 - align * width, abs=3)  # side bearings
    assert 15 < rows.min() < 30 < rows.max() < 36  # the g and the p reach below the line


@pytest.mark.parametrize(("span", "step"), [(1.0, 0.5), (4.0, 1.0), (6.5, 2.0), (44.0, 20.0), (0.03, 0.01)])
def test_ticks_are_round(span, step):
    assert spacing(span) == pytest.approx(step)


def test_limits_hold_every_value():
    low, high = limits([np.array([np.nan, 3.2, -7.0]), np.array([])], 1.0)
    assert low <= -7.0
    assert high >= 3.2
    assert limits([np.array([-1e-9, 3.2])], 1.0)[0] == 0.0
    assert limits([np.array([np.nan])], 1.0) == (0.0, 1.0)


def test_colours_are_those_of_the_figures():
    def code(colour: palette.Colour) -> str:
        return "#{:02X}{:02X}{:02X}".format(*colour)

    assert tuple(map(code, (palette.SLIP, palette.MU_C, palette.MU_S))) == STYLE.palette[:3]
    assert code(palette.GRIP_2) in STYLE.palette
    assert tuple(map(code, (palette.INK, palette.MUTED, palette.RULE))) == (
        STYLE.ink,
        STYLE.muted,
        STYLE.band,
    )
