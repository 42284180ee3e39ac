"""Compiles a task's declarations into the two functions that a simulation calls in every control step."""

from __future__ import annotations

import inspect
import warnings
from typing import Any

from numba.core.dispatcher import Dispatcher

from slipgym._numba.compiled import compiled
from slipgym._numba.generate import generate
from slipgym.tasks.episode import detect_drop, drive_wrist, limited


def track_arguments(track: Any) -> tuple[str, ...]:
    """Arguments that a task's `track` takes: `fingers` came later, and those written before do without.

    Raises:
        ValueError: It takes neither (episode, world, fingers) nor (episode, world).
    """
    function = track.py_func if isinstance(track, Dispatcher) else track
    takes = inspect.signature(function)
    for arguments in (("episode", "world", "fingers"), ("episode", "world")):
        try:
            takes.bind(*arguments)
        except TypeError:
            continue
        if "fingers" not in arguments:
            message = f"{function.__name__}{takes} should take (episode, world, fingers), like a term"
            code = function.__code__
            place = code.co_filename, code.co_firstlineno, function.__module__
            warnings.warn_explicit(message, DeprecationWarning, *place)
        return arguments
    raise ValueError(f"track = {function.__name__}{takes} must take (episode, world, fingers)")


def inlined(function: Any) -> Any:
    """Compile a function as a part of compiled ones; return it unchanged if it is compiled already."""
    return function if isinstance(function, Dispatcher) else compiled(function)


def compile_script_wrist(task: Any, file: str) -> Any:
    """Builds `script_wrist(episodes, worlds)` of a `Task`, whose source is a file."""
    wrist_velocity = task.wrist_velocity
    velocity = "0.0, 0.0, 0.0" if wrist_velocity is None else "wrist_velocity(episodes[i], worlds[i])"
    body = [
        "for i in range(episodes.shape[0]):",
        f"    x, z, pitch = {velocity}",
        "    drive_wrist(episodes[i], worlds[i], x, z, pitch)",
    ]
    namespace: dict[str, Any] = {"drive_wrist": drive_wrist}
    if wrist_velocity is not None:
        namespace["wrist_velocity"] = inlined(wrist_velocity)
    doc = "Before a control step: the wrist moves as the task scripts and as the agent commands."
    return generate(f"script_wrist_{task.key}", ("episodes", "worlds"), body, namespace, compiled, file, doc)


def compile_evaluate_step(task: Any, file: str) -> Any:
    """Builds `evaluate_step(episodes, worlds, grippers, columns)` of a `Task`, whose source is a file."""
    functions = {name: getattr(task, name) for name in ("track", "violated", "ends", "success")}
    namespace: dict[str, Any] = {"detect_drop": detect_drop, "limited": limited}
    namespace |= {name: inlined(each) for name, each in functions.items() if each is not None}
    violated = " or violated(episode, world, fingers)" if "violated" in namespace else ""
    ends = "ends(episode, world) or " if "ends" in namespace else ""
    success = " and success(episode, world)" if "success" in namespace else ""
    body = [
        "for i in range(episodes.shape[0]):",
        "    episode, world, fingers = episodes[i], worlds[i], grippers[i]",
        *([f"    track({', '.join(track_arguments(task.track))})"] if "track" in namespace else []),
        "    episode.dropped = detect_drop(episode, world, fingers)",
        "    before = episode.violated",
        f"    episode.violated = before{violated}",
        "    episode.just_violated = episode.violated and not before",
        "    lost = episode.violated and episode.end_at_violation",
        f"    episode.ended = not episode.dropped and ({ends}lost)",
        "    over = episode.ended or episode.step >= episode.steps",
        f"    episode.success = over and not episode.dropped and not episode.violated{success}",
        "    share = 1.0 / episode.steps",
    ]
    for k, term in enumerate(task.terms):
        namespace[f"term_{term.name}"] = inlined(term.value)
        value = f"term_{term.name}(episode, world, fingers)"
        paid = value if term.event else f"share * limited({value})"
        body.append(f"    episode.terms[{k}] = episode.scales[{k}] * {paid}")
    for k, column in enumerate(task.columns):
        read = column.read
        if not isinstance(read, str):
            namespace[f"column_{column.name}"] = inlined(read)
            read = f"column_{column.name}(episode, world, fingers)"
        body.append(f"    columns[i, {k}] = {read}  # {column.name}")
    arguments = "episodes", "worlds", "grippers", "columns"
    doc = "After a control step: drop, violation, success, what the terms of the reward pay, columns."
    return generate(f"evaluate_step_{task.key}", arguments, body, namespace, compiled, file, doc)
