"""Dense terms are bounded by their scales, events are paid once, and success pays more than all the rest."""

import dataclasses
import math

import numpy as np
import pytest

from slipgym.tasks import TASKS, event, term
from slipgym.tasks.episode import EPISODE
from slipgym.world.records import FINGER, WORLD

ALL = pytest.mark.parametrize("task", TASKS.values(), ids=list(TASKS))
FAR = {"Hold": (0.0, -0.01, 0.0), "Hinge": (0.0, -0.01, 0.0), "RotationalSlip": (0.0, -0.01, -0.4)}
"""Task -> a slip displacement after which no success is possible."""


def paid(value, kind, steps=50, scale=3.0):
    """What a term of this value pays in a step."""

    @kind(scale=scale)
    def one(episode, world, fingers):
        """The settled slip."""
        return world.slip[0]

    task = dataclasses.replace(TASKS["LinearSlip"], terms=(one,), key=f"one_{kind.__name__}")
    episodes, worlds = np.zeros(1, EPISODE), np.zeros(1, WORLD)
    episodes["steps"], episodes["scales"], worlds["slip"][:, 0] = steps, scale, value
    episodes["step_time"] = 0.01
    fingers = np.zeros((1, 2), FINGER)
    task.evaluate_step(episodes, worlds, fingers, np.zeros((1, len(task.columns))))
    return episodes["terms"][0, 0].item()


@pytest.mark.parametrize(("value", "share"), [(0.5, 0.5), (-0.5, -0.5), (7.0, 1.0), (-7.0, -1.0)])
def test_a_dense_term_pays_at_most_its_scale_in_an_episode(value, share):
    assert 50 * paid(value, term) == pytest.approx(3.0 * share)
    assert paid(value, event) == 3.0 * value


def test_a_term_that_is_no_number_is_not_hidden():
    assert math.isnan(paid(math.nan, term))
    assert math.isnan(paid(math.nan, event))


@ALL
def test_a_success_pays_more_than_any_failure(task):
    scales = task.default_settings["reward"]
    dense = sum(scales[each.name] for each in task.terms if not each.event)
    assert scales["solved"] - dense > dense
    assert {"solved", "drop"} <= set(task.term_names)
    assert ("violated" in task.term_names) == (task.violated is not None)
    assert "violated" in [column.name for column in task.columns]


@pytest.mark.parametrize("name", FAR)
def test_a_violation_is_paid_once_and_stays(hand, name):
    state = hand(name)
    at = [column.name for column in state.task.columns].index("violated")
    end = state.episode["steps"]
    for step, slip, charged, seen in (
        (10, (0.0, 0.0, 0.0), 0.0, 0.0),
        (11, FAR[name], -1.0, 1.0),
        (12, FAR[name], 0.0, 1.0),
        (end, (0.0, 0.0, -state.episode["goal"]), 0.0, 1.0),
    ):
        terms = state.evaluate(step, slip=slip)
        assert (terms["violated"], state.columns[0, at]) == (charged, seen)
        assert terms["solved"] == 0.0
    assert not state.episode["success"]


def test_a_success_is_paid_at_the_end(hand):
    state = hand("Hold")
    end = state.episode["steps"]
    paid = [state.evaluate(step)["solved"] for step in (1, end - 1, end)]
    assert paid == [0.0, 0.0, 1.0]


def test_a_drop_is_paid_and_is_no_success(hand):
    state = hand("Hold")
    state.fingers["contact_force"] = 0.0
    terms = state.evaluate(state.episode["steps"])
    assert (terms["drop"], terms["solved"]) == (-1.0, 0.0)


def test_a_task_needs_a_criterion():
    with pytest.raises(ValueError, match=r"slipgym/Hold-v0 needs `success`, `violated` or both"):
        dataclasses.replace(TASKS["Hold"], violated=None)
