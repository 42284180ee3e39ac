"""The functions of a task's file one by one, and how a fault in one of them is described."""

from __future__ import annotations

import linecache
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from slipgym._numba.generate import generate
from slipgym.config.errors import unknown
from slipgym.tasks.compile import track_arguments
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
