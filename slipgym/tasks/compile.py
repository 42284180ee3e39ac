"""Compiles a task's functions into the two that a simulation calls in every control step; describes faults.

Numba reports a fault in some hundred lines.
"""

from __future__ import annotations

import ast
import inspect
import linecache
import textwrap
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any, NamedTuple

from numba import from_dtype, types
from numba.core.dispatcher import Dispatcher
from numba.core.errors import NumbaError

from slipgym._numba.compiled import compiled
from slipgym._numba.generate import generate
from slipgym.config.errors import unknown
from slipgym.tasks.episode import EPISODE, detect_drop, drive_wrist, limited
from slipgym.world.records import FINGER, WORLD


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


RECORDS = {"episode": EPISODE, "world": WORLD, "fingers": FINGER}
"""What the arguments of a task's functions are records of."""
_ALL = tuple(RECORDS)
NUMBER, TRUTH, THREE = "a number", "true or false", "three numbers (x, z, pitch)"


class Function(NamedTuple):
    """A function of a task's file."""

    name: str
    """What it is in the task."""
    call: Callable[..., Any]
    """It, compiled or not."""
    takes: tuple[str, ...]
    """Its arguments, of `RECORDS`, by place."""
    returns: str
    """What it must return: NUMBER, TRUTH, THREE, or empty: anything."""
    text: str = ""
    """The expression of a column that has one in place of a function."""

    @property
    def source(self) -> Any:
        """The Python function."""
        return getattr(self.call, "py_func", self.call)

    def fault(self, what: str, line: int = 0, file: str = "") -> str:
        """Says in a few lines where something is wrong, and what.

        Args:
            what: What is wrong.
            line: Its line; 0: the function's first.
            file: The file of the line; empty: the function's.
        """
        code = self.source.__code__
        file, line = file or code.co_filename, line or code.co_firstlineno
        while linecache.getline(file, line).lstrip().startswith("@"):
            line += 1
        if self.text:
            return f"{self.name}, file {file}:\n    {self.text}\n{what}"
        return f"{self.name}, file {file}, line {line}:\n    {linecache.getline(file, line).strip()}\n{what}"


def functions(task: Any) -> Iterator[Function]:
    """The functions of a task, in the order in which they are called."""
    pair, track = ("episode", "world"), task.track
    own = (
        ("wrist_velocity", pair, THREE),
        ("track", pair if track is None else track_arguments(track), ""),
        ("violated", _ALL, TRUTH),
        ("ends", pair, TRUTH),
        ("success", pair, TRUTH),
    )
    for name, takes, returns in own:
        if (call := getattr(task, name)) is not None:
            yield Function(name, call, takes, returns)
    for term in task.terms:
        yield Function(f"term {term.name}", term.value, _ALL, NUMBER)
    for name, *_, read in task.columns:
        call: Any = read
        text = ""
        if isinstance(read, str):
            file, text = task.start.__code__.co_filename, read
            call = generate(f"column_{name}", _ALL, [f"return {text}"], {}, lambda made: made, file, text)
        yield Function(f"column {name}", call, _ALL, NUMBER, text)


def no_field(record: str, name: str) -> str:
    """The message for a field that a record does not have; `record` is one of `RECORDS`."""
    return unknown(f"field of {record}:", name, RECORDS[record].names or ())


_TYPES: dict[str, Any] = {name: from_dtype(dtype) for name, dtype in RECORDS.items()}
_TYPES["fingers"] = types.Array(_TYPES["fingers"], 1, "C")
_SCALAR = types.Number, types.Boolean
_FAULTS = NumbaError, KeyError
"""What numba raises; KeyError(name) for a field that a record does not have."""


@contextmanager
def explained(task: Any) -> Iterator[None]:
    """While a task's functions are compiled: raises one short error in place of numba's.

    Raises:
        ValueError: A function does not compile; the message says function, file, line and what is wrong.
    """
    try:
        yield
    except _FAULTS:
        found = next(filter(None, map(_fault, functions(task))), None)
        if found is None:
            raise
        raise ValueError(f"{task.id} does not compile: {found}") from None


def _fault(function: Function) -> str:
    """What keeps a function from being compiled; empty: nothing."""
    arguments = tuple(_TYPES[name] for name in function.takes)
    try:
        template: Any = inlined(function.call).get_call_template(arguments, {})[0]
    except KeyError as error:
        return _unknown_field(function, str(error.args[0]))
    except NumbaError as error:
        loc = getattr(error, "loc", None)
        return function.fault(first_lines(error), *(() if loc is None else (loc.line, loc.filename)))
    kind = next(each.return_type for each in template.cases if each.args == arguments)
    if _returns(kind, function.returns):
        return ""
    return function.fault(f"returns {kind}; must return {function.returns}")


def _returns(kind: Any, wanted: str) -> bool:
    """Whether a type is what a function must return."""
    if wanted == THREE:
        return isinstance(kind, types.BaseTuple) and len(kind) == 3
    return wanted not in (NUMBER, TRUTH) or isinstance(kind, _SCALAR)


def first_lines(error: NumbaError) -> str:
    """Returns what numba says first, with the names of records in place of all their fields."""
    text = str(error)
    for name, kind in _TYPES.items():
        text = text.replace(str(kind), name)
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    said = [line for line in lines if not line.startswith("Failed in nopython mode")]
    return " ".join(said[: 2 if len(said) > 1 and said[1].startswith(">>>") else 1])


def _unknown_field(function: Function, field: str) -> str:
    """The description of a field that does not exist, with its line if it stands in the function itself."""
    source, first = function.text, 1
    if not source:
        with suppress(OSError):
            lines, first = inspect.getsourcelines(function.source)
            source = textwrap.dedent("".join(lines))
    names = dict(zip(inspect.signature(function.source).parameters, function.takes, strict=False))
    with suppress(SyntaxError):  # a lambda in the middle of a statement
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.Attribute) and node.attr == field:
                root: ast.expr = node.value
                while isinstance(root, ast.Subscript):
                    root = root.value
                record = names.get(ast.unparse(root), "fingers")
                return function.fault(no_field(record, field), first + node.lineno - 1)
    records = (no_field(name, field) for name in function.takes)
    best = next((each for each in records if "did you mean" in each), f"no record has a field {field!r}")
    return function.fault(f"{best} (in a function that it calls)")
