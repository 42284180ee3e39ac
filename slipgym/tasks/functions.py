"""Describes faults in the functions of a task's file, those that numba reports in some hundred lines, too."""

from __future__ import annotations

import ast
import inspect
import linecache
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, NamedTuple

from numba import from_dtype, types
from numba.core.errors import NumbaError

from slipgym._numba.generate import generate
from slipgym.config.errors import unknown
from slipgym.tasks.compile import inlined, track_arguments
from slipgym.tasks.episode import EPISODE
from slipgym.world.records import FINGER, WORLD

if TYPE_CHECKING:
    from slipgym.tasks.task import Task

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


def functions(task: Task[Any]) -> Iterator[Function]:
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
def explained(task: Task[Any]) -> Iterator[None]:
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
        return function.fault(_first_lines(error), *(() if loc is None else (loc.line, loc.filename)))
    kind = next(each.return_type for each in template.cases if each.args == arguments)
    if _returns(kind, function.returns):
        return ""
    return function.fault(f"returns {kind}; must return {function.returns}")


def _returns(kind: Any, wanted: str) -> bool:
    """Whether a type is what a function must return."""
    if wanted == THREE:
        return isinstance(kind, types.BaseTuple) and len(kind) == 3
    return wanted not in (NUMBER, TRUTH) or isinstance(kind, _SCALAR)


def _first_lines(error: NumbaError) -> str:
    """What numba says first, with the names of records in place of all their fields."""
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
