"""Explains why a task's functions do not compile: numba says it in some hundred lines."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from numba import from_dtype, types
from numba.core.errors import NumbaError

from slipgym.tasks.compile import inlined
from slipgym.tasks.functions import NUMBER, RECORDS, THREE, TRUTH, Function, functions, no_field

if TYPE_CHECKING:
    from slipgym.tasks.task import Task

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
