"""What the holding controller makes of slip in a grip that should hold."""

import numpy as np
import pytest

from policies.controllers import friction_fall
from policies.controllers.friction_fall import CATCH, DEEPEST, FASTER, REST, SPRING, SPRUNG, UNBOUNDED
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


@pytest.mark.parametrize(("slip", "again"), [(0.5 * SPRUNG, False), (1.5 * SPRUNG, True)])
def test_on_pads_that_came_back_only_what_is_faster_is_a_fall(slip, again):
    """The second event is a little faster than the first, the third more than twice as fast."""
    speeds = [0.0, 0.02, *np.zeros(REST + 2), 0.03, *np.zeros(REST + 2), 1.1 * FASTER * 0.03, 0.0]
    _, catches = noticed([0.3] * len(speeds), speeds, slip=slip)
    begun = np.flatnonzero(catches)[::CATCH].tolist()
    first, second, third = np.flatnonzero(speeds).tolist()
    assert begun == [first, second, third] if again else begun == [first, third]


@pytest.mark.parametrize("changes", [{"known": False}, {"assumed": 0.2}])
def test_slip_that_contradicts_nothing_changes_nothing(changes):
    bounds, catches = noticed(*episode(0.02, 0.05), slip=2.0 * SPRING, **changes)
    assert (bounds == UNBOUNDED).all()
    assert not catches.any()


def test_friction_does_not_fall_below_what_is_plausible():
    ratios, speeds = episode(0.02, 0.05)
    bounds, _ = noticed([0.01] * len(ratios), speeds, slip=2.0 * SPRING)
    assert bounds.min() == pytest.approx(DEEPEST * 0.4)


def test_the_grip_is_braced_in_a_push_and_not_while_the_load_rings_after_it():
    policy = HoldPolicy(exploration=None)
    row = np.zeros((1, policy.index["confidence_r"] + 1))
    known = dict.fromkeys(("confidence_mu_s", "confidence_mu_c", "confidence_r"), 1.0)
    for name, value in {"mu_s": 0.5, "mu_c": 0.4, "r": 0.01, "f_n_1": 20.0, "f_n_2": 20.0, **known}.items():
        row[0, policy.index[name]] = value
    state, grips = None, []
    for load in (*np.ones(40), 2.5, 1.6, 2.3, 1.7, *np.full(60, 2.0), 3.5):
        row[0, [policy.index["f_x_1"], policy.index["f_x_2"]]] = load
        action, state = policy.predict(row, state)
        grips.append(1.0 + action[0, 0])
    braced = np.flatnonzero(np.array(grips) > 1.5 * np.median(grips)).tolist()
    assert braced == [40, len(grips) - 1]


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


@pytest.mark.slow
@pytest.mark.parametrize("pads", ["none", "lab"])
def test_a_laboratorys_sensors_and_soft_pads_cost_a_grip_with_known_friction_little(play_batch, pads):
    """Elastic shear of the pads is no slip, and a load that rings is no push."""
    keywords = {"level": "standard", "sensors": "lab", "randomization": pads, "friction_source": "true"}
    assert play_batch("slipgym/Hold-v0", HoldPolicy(), 300, 50_000, **keywords).success >= 0.75
