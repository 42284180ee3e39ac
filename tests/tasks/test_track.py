"""A task keeps its state in `track` alone, which gets the fingers; one of two arguments still works."""

import dataclasses
import warnings

import numba
import numpy as np
import pytest

from slipgym.envs import environment
from slipgym.tasks import TASKS
from slipgym.tasks.compile import inlined


def old(episode, world):
    episode.reference[0] = 2.0 * world.slip[1]


def optional(episode, world, fingers=None):
    episode.reference[0] = 2.0 * world.slip[1]


def new(episode, world, fingers):
    episode.reference[0] = 2.0 * world.slip[1]


def grip(episode, world, fingers):
    episode.reference[0] = fingers[0].force


def references(track, steps=30):
    """The first number of the reference in some steps with the agent's grip below what holds the object."""
    task = dataclasses.replace(TASKS["LinearSlip"], track=track)
    env = environment(task)(engine="planar")
    env.reset(seed=0)
    return [env.step([-0.95])[4]["reference"][0] for _ in range(steps)], env


@pytest.mark.parametrize("compiled", [False, True])
def test_a_track_of_two_arguments_works_and_is_deprecated(compiled):
    meant = r"old\(episode, world\) should take \(episode, world, fingers\)"
    with pytest.warns(DeprecationWarning, match=meant) as said:
        found, _ = references(numba.njit(old) if compiled else old)
    assert [each.filename for each in said] == [__file__]
    assert found == references(new)[0]
    assert len(set(found)) > 10


def test_a_track_of_three_arguments_gets_the_fingers():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        references(optional)
        found, env = references(grip)
    assert found[-1] == env.simulation.plant.fingers["force"][0, 0] > 0.0


@pytest.mark.parametrize("track", [lambda episode: None, lambda a, b, c, d: None])
def test_another_number_of_arguments_is_refused(track):
    task = dataclasses.replace(TASKS["LinearSlip"], track=track)
    with pytest.raises(ValueError, match=r"must take \(episode, world, fingers\)"):
        environment(task)(engine="planar")


def changed_by(function, simulation, count):
    """Names of the arrays that a function of the first environment's records changes."""
    called = inlined(function)
    arrays = simulation.episode, simulation.plant.world, simulation.plant.fingers

    if count == 3:

        @numba.njit
        def call(episodes, worlds, grippers):
            return called(episodes[0], worlds[0], grippers[0])

    else:

        @numba.njit
        def call(episodes, worlds, grippers):
            return called(episodes[0], worlds[0])

    before = [array.tobytes() for array in arrays]
    call(*arrays)
    return [k for k, array in enumerate(arrays) if array.tobytes() != before[k]]


@pytest.mark.parametrize("name", sorted(TASKS))
def test_predicates_change_nothing(name):
    task = TASKS[name]
    options = {"grip_limit": 2.0, "grip_limit_start": 0.0} if name == "Hold" else {}
    env = environment(task)(engine="planar")
    env.reset(seed=1, options=options)
    for _ in range(5):
        env.step(np.zeros(env.action_space.shape))
    simulation = env.simulation
    simulation.episode["step"] += 1  # as in the control step that the predicates would judge next
    for predicate, count in ((task.violated, 3), (task.ends, 2), (task.success, 2)):
        if predicate is not None:
            assert changed_by(predicate, simulation, count) == []


def test_a_predicate_with_a_side_effect_is_found():
    def violated(episode, world, fingers):
        episode.own[0] += fingers[0].force
        return False

    env = environment(TASKS["Hold"])(engine="planar")
    env.reset(seed=1)
    assert changed_by(violated, env.simulation, 3) == [0]


def test_the_grip_is_added_up_once_in_each_step_that_counts():
    env = environment(TASKS["Hold"])(engine="planar")
    env.reset(seed=0, options={"grip_limit": 5.0, "grip_limit_start": 10 / 120})
    total = 0.0
    for step in range(1, 31):
        env.step([0.0])
        total += env.simulation.plant.fingers["force"][0].mean() if step > 10 else 0.0
    assert env.simulation.episode["grip_sum"][0] == pytest.approx(total, rel=1e-12)
