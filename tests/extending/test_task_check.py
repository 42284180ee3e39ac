"""Faults in the functions of a task: what `check` finds, and what is said where they do not compile."""

import dataclasses
import re

import numba
import pytest

from slipgym.envs.slip_env import SlipEnv
from slipgym.tasks import TASKS, Column, check, term

HERE = re.escape(__file__)


@numba.njit
def helper(episode):
    return episode.gool


@term(scale=1.0)
def misspelled(episode, world, fingers):
    """A field that does not exist, where the object has fallen."""
    if world.slip[1] < -1.0:
        return episode.gaol
    return 0.0


@term(scale=1.0)
def called(episode, world, fingers):
    """The same in a function that it calls."""
    return helper(episode)


@term(scale=1.0)
def mistyped(episode, world, fingers):
    """The size of an array."""
    return abs(world.slip)


@term(scale=1.0)
def forgotten(episode, world, fingers):
    """Returns nothing."""
    episode.goal + 1.0


@term(scale=1.0)
def undefined(episode, world, fingers):
    """0 / 0."""
    return fingers[0].reaction[0] * 0.0 / (episode.goal - episode.goal)


@term(scale=1.0)
def divided(episode, world, fingers):
    """Plain numbers, of which Python itself refuses the division."""
    return 1.0 / float(episode.goal - episode.goal)


def written(episode, world, fingers):
    """A field that does not exist is written."""
    episode.refrence = 0.0


def spread(episode, world, fingers):
    """NaN goes into the reference."""
    episode.reference[1] = world.mass * 0.0 / episode.reference[2]


def nothing(episode, world):
    """No answer."""


def moves(episode, world, fingers):
    """Only the engine may do so."""
    world.slip[1] = 0.0


@term(scale=1.0)
def shifts(episode, world, fingers):
    """Only track may do so."""
    episode.goal = 0.02
    return 0.0


def partly(episode, world):
    """A share in place of a truth value."""
    return 0.3


def begin(settings, options, rng, episode):
    """A field that does not exist."""
    episode["gaol"] = 1.0


def with_term(task, added):
    return dataclasses.replace(task, terms=(*task.terms, added))


@pytest.mark.parametrize("name", TASKS)
def test_nothing_is_found_in_slipgyms_own(name):
    assert check(TASKS[name]) == []


def test_nothing_is_found_in_that_of_the_page(own_task):
    assert check(own_task.TASK) == []


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"terms": (called,)},
            r"term called.* line \d+:\n    return episode\.gool\nunknown field .*did you mean 'goal'",
        ),
        ({"terms": (forgotten,)}, r"term forgotten.*\n.*def forgotten.*\nreturns None; must return a number"),
        (
            {"terms": (undefined,)},
            r"term undefined.*\n.*return fingers.*\nreturns .*nan.*; FloatingPointError: invalid value",
        ),
        (
            {"terms": (divided,)},
            r"term divided.*\n.*return 1\.0 /.*\nZeroDivisionError: .*compiled, it gives NaN or infinity",
        ),
        ({"track": written}, r"track, .*\n.*episode\.refrence = 0\.0\nunknown .*'refrence'.*'reference'"),
        (
            {"track": spread},
            r"track, .*\n.*world\.mass.*\nwrites a number that is not finite .*invalid value",
        ),
        ({"track": moves}, r"track, .*\n.*def moves.*\nwrites world\.slip; only track may write"),
        ({"terms": (shifts,)}, r"term shifts.*\n.*def shifts.*\nwrites episode\.goal; only track may"),
        ({"success": partly}, r"success, .*\n.*def partly.*\nreturns 0\.3; must return true or false"),
        ({"success": nothing}, r"success, .*\n.*def nothing.*\nreturns None; must return true or false"),
        ({"start": begin}, r"start, .*\n.*\[.gaol.\] = 1\.0\nunknown field .*did you mean 'goal'"),
        ({"wrist_velocity": nothing}, r"returns None; must return three numbers \(x, z, pitch\)"),
    ],
)
def test_what_is_wrong_is_named(own_task, changes, said):
    (found,) = check(dataclasses.replace(own_task.TASK, **changes))
    assert re.search(said, found), found
    assert found.count("\n") == 2
    assert __file__ in found


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"terms": (misspelled,)},
            rf"{HERE}, line \d+:\n    return episode\.gaol\nunknown .* mean 'goal'.*step_time",
        ),
        ({"terms": (called,)}, r"def called.*\nunknown field of episode: 'gool'; did you mean 'goal'"),
        (
            {"terms": (mistyped,)},
            r"return abs\(world\.slip\)\nNo implementation .* >>> abs\(nestedarray\(float64",
        ),
        ({"terms": (forgotten,)}, r"def forgotten.*\nreturns none; must return a number"),
        ({"track": written}, r"track, .*\n.*refrence = 0\.0\nunknown .* mean 'reference'"),
        (
            {"columns": (Column("line", 0.0, 1.0, "m", "", read="world.slp[1]"),)},
            r"column line, .*\n    world\.slp\[1\]\nunknown field of world: 'slp'; did you mean 'slip'",
        ),
    ],
)
def test_what_does_not_compile_is_explained(own_task, changes, said):
    task = dataclasses.replace(own_task.TASK, **changes)
    with pytest.raises(ValueError, match=rf"my/SlideToLine-v0 does not compile: [^!]*{said}") as raised:
        type("WrongEnv", (SlipEnv,), {"task": task})(engine="planar")
    assert len(str(raised.value).splitlines()) == 3
    assert raised.value.__cause__ is None
    assert raised.value.__suppress_context__


@pytest.mark.parametrize("steps", [0, -3])
def test_a_start_without_a_length_is_refused(own_task, steps):
    def start(settings, options, rng, episode):
        own_task.start(settings, options, rng, episode)
        episode["steps"] = steps

    task = dataclasses.replace(own_task.TASK, start=start)
    with pytest.raises(ValueError, match=rf"SlideToLine-v0: start leaves episode\.steps = {steps}: expected"):
        check(task)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"columns": (Column("line", 1.0, 0.0, "m", "", read="0.0"),)},
            r"column line: low = 1\.0 must be below",
        ),
        ({"terms": (term(scale=float("nan"))(misspelled.value),)}, "term misspelled: scale = nan: expected"),
    ],
)
def test_numbers_of_the_declaration_are_checked(own_task, changes, said):
    with pytest.raises(ValueError, match=said):
        dataclasses.replace(own_task.TASK, **changes)
