"""LinearSlip's controller finds out whether the slip velocity is late, and then moves in leaps."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import policies
from policies.controllers.lateness import RESTS, SHOWN, Lateness, LatenessGains, watched
from policies.controllers.leaps import LeapGains
from policies.leaderboard.imperfections import without
from policies.stepping import batch_steps

LINEAR = "slipgym/LinearSlip-v0"
DT = 1.0 / 120.0


def watch(loads, speeds, lengths=None):
    """The memory after each of some control steps with a load of 3 N at rest."""
    past, seen = Lateness(*np.zeros((len(Lateness._fields), 1))), []
    for k, (load, speed) in enumerate(zip(loads, speeds, strict=True)):
        position = 0.0 if lengths is None else lengths[k]
        now = (np.array([value]) for value in (load, speed, position))
        past = watched(past, next(now), next(now), next(now), LatenessGains(), LeapGains(), DT)
        seen.append(past)
    return seen


@pytest.mark.parametrize(("steps", "late"), [(0, 0.0), (1, 0.0), (2, 0.0), (3, 1.0), (5, 1.0)])
def test_the_velocity_is_late_if_it_shows_a_break_away_more_than_two_steps_after_the_force(steps, late):
    loads = [3.0] * 10 + [2.0] * (steps + 2)
    speeds = [0.0] * (10 + steps) + [0.05] * 2
    seen = watch(loads, speeds)
    assert seen[9].waited == RESTS
    assert seen[-1].late == late
    assert seen[-1].waited == SHOWN
    assert seen[-1].load == pytest.approx(3.0)


def test_a_force_that_comes_back_was_no_break_away():
    seen = watch([3.0] * 10 + [2.5] * 2 + [3.0] * 5, [0.0] * 17)
    assert (seen[11].waited, seen[-1].waited, seen[-1].late) == (2.0, RESTS, 0.0)


def test_a_slip_that_gets_long_was_caught_late():
    lengths = [0.0] * 10 + [0.001, 0.002, 0.0035]
    seen = watch([3.0] * 10 + [2.0] * 3, [0.0] * 10 + [0.1] * 3, lengths)
    assert [each.late[0] for each in seen[-2:]] == [0.0, 1.0]


def played(name, n, **arguments):
    """The actions of a controller in a batch, its last memory and whether the episodes were solved."""
    policy: Any = policies.make(name)
    env: Any = gym.make_vec(LINEAR, num_envs=n, **policies.modes(policy), **arguments).unwrapped
    observations, _ = env.reset(seed=50_000)
    actions, solved = [], np.zeros(n, dtype=bool)
    for step in batch_steps(env, policy, observations):
        actions.append(step.observations[:, policy.index["commanded_force"]])
        solved = step.infos["is_success"]
    env.close()
    return np.array(actions), solved


def test_with_a_prompt_velocity_it_is_the_continuous_controller_to_the_bit():
    chosen, solved = played("linear_slip", 16)
    continuous, _ = played("linear_slip_continuous", 16)
    assert (chosen == continuous).all()
    assert solved.all()


def test_with_a_late_velocity_it_is_solved_where_the_continuous_controller_is_not():
    late = {"randomization": {"slip_latency": {"choices": [4]}}}
    assert played("linear_slip", 32, **late)[1].mean() >= 0.95
    assert played("linear_slip_continuous", 32, **late)[1].mean() < 0.7


@pytest.mark.slow
def test_what_sensors_of_a_laboratory_cost_are_errors_of_scale_and_resting_chips(play_batch):
    made, shared = policies.make("linear_slip"), {"friction_source": "estimated"}
    assert play_batch(LINEAR, made, 800, 70_000, sensors="realistic", **shared).success == 1.0
    whole = play_batch(LINEAR, made, 800, 70_000, sensors="lab", **shared)
    rest = without(["scale", "resting chips"])
    others = play_batch(LINEAR, made, 800, 70_000, sensors="lab", config=rest, **shared)
    assert whole.success <= 0.97 < 0.99 <= others.success
