"""PlanarSlip on states made by hand."""

import math

import numpy as np
import pytest

from slipgym.tasks import TASKS, configure
from slipgym.tasks.planar_slip import SCRATCH, hang

PLAN = {"slide": 0.015, "heading": 0.4, "turn": -0.3}
END = 1440


def test_the_target_is_where_the_plan_ends():
    """A slide along gravity in the pitched pad frame, then a turn about the pad centre."""
    slide = 0.015 * np.array([-math.sin(0.4), -math.cos(0.4)])
    turn = np.array([[math.cos(-0.3), -math.sin(-0.3)], [math.sin(-0.3), math.cos(-0.3)]])
    np.testing.assert_allclose(hang(0.015, 0.4, -0.3), [*(turn @ slide), -0.3], rtol=1e-12)


def test_the_target_is_drawn_within_its_ranges(hand):
    settings = configure(TASKS["PlanarSlip"])[1]
    state, rng = hand("PlanarSlip"), np.random.default_rng(1)
    targets = []
    for _ in range(500):
        TASKS["PlanarSlip"].start(settings, TASKS["PlanarSlip"].options.parse({}), rng, state.episode)
        targets.append(state.episode["own"][SCRATCH.target].copy())
    x, y, theta = np.array(targets).T
    slide, heading = np.hypot(x, y), theta + np.arctan2(-x, -y)
    assert settings.slide[0] <= slide.min() < slide.max() <= settings.slide[1]
    assert settings.turn[0] <= np.abs(theta).min() < np.abs(theta).max() <= settings.turn[1]
    assert np.abs(heading).max() <= settings.heading + 1e-12
    for values in (theta, heading):
        assert 0.4 < (values > 0.0).mean() < 0.6


def test_an_option_shifts_no_other_draw(hand):
    drawn, fixed = hand("PlanarSlip"), hand("PlanarSlip", turn=0.0)
    np.testing.assert_allclose(
        np.hypot(*fixed.episode["own"][SCRATCH.target][:2]),
        np.hypot(*drawn.episode["own"][SCRATCH.target][:2]),
    )
    assert fixed.episode["own"][SCRATCH.target][2] == 0.0


def test_terms_and_columns(hand):
    state = hand("PlanarSlip", **PLAN, tolerance=0.001, angle_tolerance=0.1)
    x, y, theta = target = hang(**PLAN)
    state.episode["wrist_command"] = 0.15, -0.2, 1.5
    terms = state.evaluate(120, slip=(x + 0.0012, y - 0.0016, theta + 0.05))
    assert terms["position"] == pytest.approx(math.exp(-4.0))
    assert terms["angle"] == pytest.approx(math.exp(-0.25))
    assert terms["distance"] == pytest.approx(-0.125)
    assert terms["wrist"] == pytest.approx(-0.5)
    assert state.columns[0].tolist() == pytest.approx([*target, 11.0, 0.0])
    assert state.evaluate(120, slip=(0.1, 0.1, 0.0))["distance"] == -1.0


@pytest.mark.parametrize(
    ("off", "twist", "success"),
    [
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), True),
        ((0.0014, -0.0014, 0.052), (0.0007, 0.0, 0.04), True),
        ((0.0015, -0.0014, 0.0), (0.0, 0.0, 0.0), False),
        ((0.0, 0.0, 0.053), (0.0, 0.0, 0.0), False),
        ((0.0, 0.0, 0.0), (0.0, 0.0011, 0.0), False),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.07), False),
    ],
)
def test_success_is_at_the_target_and_at_rest(hand, off, twist, success):
    state = hand("PlanarSlip", **PLAN)
    state.episode["pad_radius"] = 0.015
    slip = np.add(hang(**PLAN), off)
    state.evaluate(END - 1, slip=slip, slip_twist=twist)
    assert not state.episode["success"]
    state.evaluate(END, slip=slip, slip_twist=twist)
    assert state.episode["success"] == success
