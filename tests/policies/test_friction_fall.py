"""What the holding controller makes of slip in a grip that should hold."""

import numpy as np
import pytest

from policies.controllers import friction_fall
from policies.controllers.friction_fall import CATCH, DEEPEST, REST, SPRING, UNBOUNDED
from policies.controllers.hold import HoldPolicy

JUMP = {
    "disturbances": [
        {
            "kind": "friction_jump",
            "probability": 1.0,
            "time": {"uniform": [1.0, 7.0]},
            "factor": {"uniform": [0.5, 0.8]},
        }
    ]
}


def noticed(ratios, speeds, slip=0.0, known=True, assumed=0.4):
    """Bounds and catches over control steps of a grip of 5 N; `slip` is measured after the first speed."""
    state, bounds, catches, moved = friction_fall.begin(1), [], [], False
    for ratio, speed in zip(ratios, speeds, strict=True):
        moved |= speed > 0.0
        load, grip, pace = (np.array([value]) for value in (5.0 * ratio, 5.0, speed))
        at = np.array([slip if moved else 0.0]), np.zeros(1)
        limits = np.array([assumed]), np.array([known])
        catch, state = friction_fall.notice(state, load, grip, pace, at, *limits)
        bounds.append(state.bound[0])
        catches.append(catch[0])
    return np.array(bounds), np.array(catches)


def episode(*speeds):
    rest = REST + 4
    return [0.3, 0.3, 0.3] + [0.25] * len(speeds) + [0.1] * rest, [0.0] * 3 + list(speeds) + [0.0] * rest


def test_slip_at_a_ratio_that_should_hold_bounds_friction_for_good():
    bounds, catches = noticed(*episode(0.02, 0.05, 0.05), slip=2.0 * SPRING)
    assert bounds[2] == UNBOUNDED
    assert bounds[3] == pytest.approx(0.3)  # the largest of three
    np.testing.assert_allclose(bounds[4:], 0.3)  # it rises; the two before: 0.25 and 0.3
    assert np.flatnonzero(catches).tolist() == list(range(3, 3 + CATCH))


def test_a_break_away_does_not_count_while_the_velocity_rises():
    ratios, speeds = episode(0.02, 0.05, 0.05)
    ratios[1], ratios[2], ratios[3] = 0.38, 0.25, 0.25
    bounds, _ = noticed(ratios, speeds, slip=2.0 * SPRING)
    assert bounds[3] == pytest.approx(0.38)
    np.testing.assert_allclose(bounds[4:], 0.25)


def test_what_a_soft_pad_springs_is_forgotten():
    bounds, _ = noticed(*episode(0.02, 0.05), slip=0.5 * SPRING)
    assert bounds[4] < 0.4
    assert bounds[-1] == UNBOUNDED


@pytest.mark.parametrize("changes", [{"known": False}, {"assumed": 0.2}])
def test_slip_that_contradicts_nothing_changes_nothing(changes):
    bounds, catches = noticed(*episode(0.02, 0.05), slip=2.0 * SPRING, **changes)
    assert (bounds == UNBOUNDED).all()
    assert not catches.any()


def test_friction_does_not_fall_below_what_is_plausible():
    ratios, speeds = episode(0.02, 0.05)
    bounds, _ = noticed([0.01] * len(ratios), speeds, slip=2.0 * SPRING)
    assert bounds.min() == pytest.approx(DEEPEST * 0.4)


@pytest.mark.slow
def test_after_a_fall_of_friction_it_holds_more_often_than_without_doubt(play_batch):
    """In 95 % of the episodes, at no more than 1.15 times the grip of the truth; half as many failures."""
    keywords = {"randomization": JUMP, "friction_source": "estimated"}
    hold = "slipgym/Hold-v0"
    found = play_batch(hold, HoldPolicy(), 300, 50_000, **keywords)
    light = play_batch(hold, HoldPolicy(stale=1.0), 300, 50_000, **keywords)
    without = play_batch(hold, HoldPolicy(stale=1.0, doubt=0.0), 300, 50_000, **keywords)
    true = play_batch(hold, HoldPolicy(), 300, 50_000, **{**keywords, "friction_source": "true"})
    assert found.success >= 0.95
    assert 1.0 - light.success <= 0.5 * (1.0 - without.success)
    assert found.grip <= 1.15 * true.grip


@pytest.mark.slow
def test_without_a_fall_of_friction_it_costs_little(play_batch):
    keywords = {"friction_source": "estimated"}
    found = play_batch("slipgym/Hold-v0", HoldPolicy(), 300, 50_000, **keywords)
    without = play_batch("slipgym/Hold-v0", HoldPolicy(doubt=0.0), 300, 50_000, **keywords)
    assert found.success >= 0.98
    assert found.grip <= 1.03 * without.grip
