"""Lines, triangles, words and plots do what they say."""

import numpy as np
import pytest
from PIL import Image

from policies.evaluation.plots.style import STYLE
from slipgym.rendering import palette
from slipgym.rendering.plot import Curve, Plot, limits, spacing
from slipgym.rendering.scene import fill
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


def drawn(values, width, dash=0.0):
    """Coverage 0 to 1 of a curve over 10 s in a plot from 0 to 1, 200 by 100 pixels with a margin of 20."""
    picture = Image.new("RGB", (240, 140), palette.PAPER)
    plot = Plot(20, 20, 220, 120, 10.0, 0.0, 1.0)
    times = np.linspace(0.0, 10.0, len(values))
    plot.draw(picture, times, [], clock=False)
    before = np.asarray(picture, float)
    plot.draw(picture, times, [Curve(np.array(values), (0, 0, 0), width, dash)], clock=False)
    return (1.0 - np.asarray(picture, float) / np.maximum(before, 1.0))[24:116].mean(axis=2)


@pytest.mark.parametrize("rise", [0.0, 0.2, 0.5])
def test_a_curve_covers_length_times_width(rise):
    gap = np.nan
    mask = drawn([0.3, 0.3 + rise, gap], 4.0)  # 100 pixels to the right; it does not end at a dot
    assert mask.sum() == pytest.approx(np.hypot(100.0, 100.0 * rise) * 4.0, rel=0.1)


def test_a_curve_breaks_where_there_is_nothing():
    mask = drawn([0.5, 0.5, np.nan, 0.5, 0.5], 2.0)
    seen = mask.max(axis=0)
    assert (seen[25:65] == 1.0).all()
    assert (seen[75:165] == 0.0).all()
    assert (seen[175:215] == 1.0).all()


def test_dashes_cover_half():
    line, dashes = (drawn([0.5, 0.5, np.nan], 2.0, dash).sum() for dash in (0.0, 5.0))
    assert dashes == pytest.approx(0.5 * line, rel=0.1)


@pytest.mark.parametrize("align", [0.0, 0.5, 1.0])
def test_words_stand_where_they_are_put(align):
    image = Image.new("RGB", (200, 40), palette.PAPER)
    write(image, 100, 30, "grip", palette.INK, 13, align)
    picture = np.asarray(image)
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
