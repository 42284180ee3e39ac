"""Declares readings of a simulation as table rows, and generates the compiled functions that write them.

A row holds a number's name and the expression that computes it. The generated functions write the value of
row k to place k, so that names and values cannot be mixed up.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

from slipgym._numba.compiled import compiled
from slipgym._numba.generate import generate
from slipgym.config import Config
from slipgym.tasks.task import Column

Limits: TypeAlias = tuple[float, float] | Callable[[Config], tuple[float, float]]
"""Lowest and highest value: two numbers, or a function that takes them from the configuration."""


class Reading(NamedTuple):
    """One number that an environment reports."""

    name: str
    limits: Limits
    unit: str
    meaning: str
    read: str
    """Expression for environment i in terms of the writer's arguments, "worlds[i].angle" for example;
    empty for a reading that is found by its number."""

    def column(self, config: Config | None = None) -> Column:
        """The column of an observation, with the limits of a configuration if they depend on it."""
        if callable(self.limits):
            assert config is not None
            low, high = self.limits(config)
        else:
            low, high = self.limits
        return Column(self.name, low, high, self.unit, self.meaning, self.read)


def row_writer(
    name: str,
    reads: Sequence[str],
    arrays: Sequence[str],
    file: str,
    doc: str,
    before: Sequence[str] = (),
    functions: Mapping[str, Any] | None = None,
) -> Any:
    """Generate a compiled function (row, i, *arrays) that stores the value of `reads[k]` in `row[k]`.

    Args:
        name: Name of the function.
        reads: Expressions for environment i.
        arrays: Names of the arrays in the expressions.
        file: `__file__` of the module with the table.
        doc: Docstring.
        before: Statements that run before the expressions.
        functions: Compiled functions that the expressions call, by name.
    """
    body = [*before, *(f"row[{k}] = {read}" for k, read in enumerate(reads))]
    return generate(name, ("row", "i", *arrays), body, functions or {}, compiled, file, doc)


def of_state(*arrays: str) -> tuple[str]:
    """Statement before expressions that read arrays of `state`, a `slipgym.envs.control_step.BatchState`."""
    return (f"{', '.join(arrays)} = {', '.join(f'state.{name}' for name in arrays)}",)


def choice_reader(name: str, reads: Sequence[str], arrays: Sequence[str], file: str, doc: str) -> Any:
    """Generate a compiled function (k, i, *arrays) that returns `reads[k]`, see `row_writer`."""
    body = []
    for k, read in enumerate(reads):
        body += [f"if k == {k}:", f"    return {read}"]
    return generate(name, ("k", "i", *arrays), [*body, "return 0.0"], {}, compiled, file, doc)
