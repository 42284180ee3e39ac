"""RotationalSlip on states made by hand."""

import math

import pytest

OPTIONS = {"angle": 0.8, "duration": 1.0, "settle": 0.5, "hold": 0.5}
END = 240


def test_the_turn_is_symmetric_about_horizontal(hand):
    state = hand("RotationalSlip", **OPTIONS)
    assert state.episode["wrist_start"].tolist() == [0.0, 0.0, 0.4]
    assert state.episode["steps"] == END


def test_tracking_falls_with_the_error_and_sliding_with_the_slip(hand):
    state = hand("RotationalSlip", **OPTIONS, tolerance=0.1, slide_tolerance=0.001)
    middle = 120  # half way: 0.4 rad
    assert state.evaluate(middle, slip=(0.0, 0.0, -0.4))["tracking"] == pytest.approx(1.0)
    assert state.evaluate(middle, slip=(0.0, 0.0, -0.3))["tracking"] == pytest.approx(math.exp(-1.0))
    assert state.evaluate(middle, slip=(0.0003, -0.0004, -0.4))["sliding"] == pytest.approx(-0.05)
    assert state.columns[0].tolist() == pytest.approx([0.4, 1.0, 0.0, 0.8, 1.0, 0.0])


@pytest.mark.parametrize(
    ("slip", "success"),
    [
        ((0.0, 0.0, -0.8), True),
        ((0.0, 0.0009, -0.83), True),
        ((0.0, 0.0, -0.84), False),
        ((0.0, 0.0, -0.76), False),
        ((0.0, 0.0011, -0.8), False),
    ],
)
def test_success_is_the_angle_without_sliding(hand, slip, success):
    state = hand("RotationalSlip", **OPTIONS)
    state.evaluate(END - 1, slip=slip)
    assert not state.episode["success"]
    state.evaluate(END, slip=slip)
    assert state.episode["success"] == success


def test_sliding_back_does_not_help(hand):
    state = hand("RotationalSlip", **OPTIONS)
    state.evaluate(100, slip=(0.002, 0.0, -0.3))
    state.evaluate(END, slip=(0.0, 0.0, -0.8))
    assert not state.episode["success"]


@pytest.mark.parametrize(("along", "dropped"), [(0.004, False), (0.006, True)])
def test_a_bar_is_dropped_when_a_pad_reaches_its_edge(hand, along, dropped):
    """Held 180 mm from the centre of 460 mm by 40 mm, pad 15 mm: 35 mm are left along, 5 mm across."""
    state = hand("RotationalSlip", **OPTIONS)
    state.episode["object_centre"] = 0.18, 0.0
    state.episode["reach"] = 0.215, 0.005
    turned = -0.7  # first the bar moves along itself, then across
    state.evaluate(100, slip=(0.014 * math.cos(turned), 0.014 * math.sin(turned), turned))
    assert not state.episode["dropped"]
    state.evaluate(100, slip=(along * math.sin(turned), -along * math.cos(turned), turned))
    assert state.episode["dropped"] == dropped
