"""Runs the functions of a task as plain Python, which says where a fault is."""

from __future__ import annotations

import math
import re
import traceback
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium.envs.registration import load_env_creator

from estimator._numba.uncompiled import uncompiled
from slipgym.registration import ENVIRONMENTS
from slipgym.tasks.compile import RECORDS, THREE, TRUTH, Function, functions, inlined, no_field

if TYPE_CHECKING:
    from slipgym.tasks.task import Task

_MISSING = re.compile(r"no (?:attribute|field of name) '?(\w+)")
_KEPT = "reference", "own"
"""Fields of the episode that a task computes in `track`."""


def check(task: Task[Any], steps: int = 20) -> list[str]:
    """Runs every function of a task as plain Python, at the start of an episode and after each step.

    The object is held with grip forces drawn at random; the wrist moves only as the agent commands. After
    the first fault of a function it is not called again. A call in which a function makes a record of its
    own is passed over: plain Python does not read its fields as attributes.

    Args:
        task: The task; it need not be registered.
        steps: How many control steps, >= 0.

    Returns:
        A text of a few lines for each function with a fault: an exception such as that of a misspelled
        field, a wrong kind of return value, a number that is not finite, or a record that it may not write,
        with function, file and line. Empty if there is none.

    Raises:
        ValueError: The settings are not valid, or `start` leaves `steps` below 1.
    """

    def start(*given: Any) -> None:  # of this module: its programs are the same for all tasks
        task.start(*given)

    nothing = dict.fromkeys(("violated", "track", "ends", "wrist_velocity"))
    resting: Any = replace(
        task, key="resting", start=start, success=_solved, terms=(), columns=(), page=None, **nothing
    )
    begins = Function("start", task.start, ("episode",), "")
    any_env: Any = load_env_creator(next(iter(ENVIRONMENTS.values())))  # no import: they are made of tasks
    env: Any = type("RestingEnv", (any_env,), {"task": resting})(engine="planar")
    with env:
        env.action_space.seed(0)
        try:
            env.reset(seed=0)
        except Exception as error:
            return [_raised(begins, error)]
        state = env.simulation.state
        records: dict[str, Any] = {
            "episode": state.episodes.view(np.recarray)[0],
            "world": state.worlds.view(np.recarray)[0],
            "fingers": state.fingers.view(np.recarray)[0],
        }
        left, faults = list(functions(task)), []
        for step in range(steps + 1):
            if step and any(env.step(env.action_space.sample())[2:4]):
                break
            found = {each: _fault(each, [records[name] for name in each.takes]) for each in left}
            faults += filter(None, found.values())
            left = [each for each in left if not found[each]]
    return faults


def _solved(episode, world):
    """Whether the episode was a success."""
    return True


def _fault(function: Function, arguments: list[Any]) -> str:
    """What is wrong with a function's call; empty: nothing."""
    plain, before = uncompiled(inlined(function.call)), [each.copy() for each in arguments]
    may_write = function.takes[:1] if function.name == "track" else ()
    try:
        with np.errstate(all="ignore"):
            value = plain(*arguments)
    except Exception as error:
        return "" if "'numpy.void'" in str(error) else _raised(function, error)
    for name, now, then in zip(function.takes, arguments, before, strict=False):
        changed = [field for field in now.dtype.names if now[field].tobytes() != then[field].tobytes()]
        if changed and name not in may_write:
            for field in changed:
                now[field] = then[field]
            return function.fault(f"writes {name}.{changed[0]}; only track may write, and only episode")
    if function.returns == TRUTH and _is_number(value) and value not in (0, 1):
        return function.fault(f"returns {value!r}; must return {TRUTH}")
    numbers = value if function.returns == THREE and isinstance(value, tuple) else (value,)
    if function.returns:
        if len(numbers) != (3 if function.returns == THREE else 1) or not all(map(_is_number, numbers)):
            return function.fault(f"returns {value!r}; must return {function.returns}")
        what = f"returns {value!r}"
    else:
        numbers = [number for name in _KEPT for number in arguments[0][name].tolist()]
        what = "writes a number that is not finite into " + " or ".join(f"episode.{name}" for name in _KEPT)
    if all(map(math.isfinite, numbers)):
        return ""
    try:
        with np.errstate(divide="raise", invalid="raise", over="raise"):
            plain(*before)
    except Exception as error:  # where it became so
        return _raised(function, error, f"{what}; ")
    return function.fault(what)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating, np.bool_))


def _raised(function: Function, error: Exception, what: str = "") -> str:
    """The description of an exception, at the last line that it passed in the function's file."""
    frames = traceback.extract_tb(error.__traceback__)
    inside = [frame for frame in frames if frame.filename == function.source.__code__.co_filename]
    if not inside and function.name == "start":
        raise error
    said = f"{type(error).__name__}: {error}"
    if missing := _MISSING.search(str(error)):
        dtype = getattr(getattr(error, "obj", None), "dtype", None)  # unknown where a field is written
        names = [each for each in function.takes if dtype is None or RECORDS[each].names == dtype.names]
        texts = [no_field(each, missing[1]) for each in names]
        said = next((text for text in texts if "did you mean" in text), [*texts, said][0])
    elif isinstance(error, ArithmeticError) or str(error) == "math domain error":
        said += " (compiled, it gives NaN or infinity)"
    return function.fault(what + said, (inside[-1].lineno or 0) if inside else 0)
