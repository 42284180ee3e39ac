"""Reads columns of numbers, by the mapping."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from estimator.records.cells import numbers, times
from estimator.records.columns import Column, Columns
from estimator.records.record import Array, Rows
from estimator.records.units import UNITS, unit_of, units_of
from estimator.suggestions import brief, guess, unknown

_UNIT_IN_NAME = re.compile(r"[\[(]([^\[\]()]*)[\])]$")
_PLACE = re.compile(r"[\d\s,]*")
"""What brackets hold that state no unit: nothing, or the place of a column in an array."""
_SHOWN = 40
"""Most names of columns or values in a message."""


class Table(NamedTuple):
    """Columns of a file that have a common length, and how to find things in them."""

    frame: Any
    """pandas.DataFrame of the columns that were asked for; the index counts the rows from 0."""
    names: Sequence[str]
    """All columns of the file."""
    units: Mapping[str, str] = MappingProxyType({})
    """Column -> unit, where the file says it."""
    comma: bool = False
    """Whether its numbers have decimal commas."""
    name: str = ""
    """Name of the file."""
    columns: Columns = Columns()
    """The mapping."""
    joints: bool = False
    """Whether its names have brackets of its reader's own, such as those of a joint, which state no unit."""

    def has(self, key: str) -> bool:
        """Whether it holds what a key means; a column that the mapping names must be there.

        Raises:
            ValueError: The mapping names a column that is not there.
        """
        column = self.columns[key]
        found = column is not None and column.column in self.frame.columns
        if not found and self.columns.needs(key):
            self.require([key])
        return found

    def require(self, keys: Sequence[str]) -> None:
        """Refuses a file that lacks a column of one of these keys, with a line for each that is missing.

        Raises:
            ValueError: Also says what is there and what a mapping may hold.
        """
        there, lines = self.names, []
        for key in keys:
            column = self.columns[key]
            if column is not None and column.column not in self.frame.columns:
                what = f"{key}: no column" if key != column.column else "no column"
                line = f"{self.name}: {what} {brief(repr(column.column))}; {guess(column.column, there)}"
                lines.append(line.rstrip("; "))
        if lines:
            lines[-1] += f"{' ' if lines[-1].endswith('?') else '; '}it has: {listed(there)}"
            keys_of_mapping = f"map other names with --columns mapping.yaml; its keys: {', '.join(UNITS)}"
            raise ValueError("\n".join([*lines, keys_of_mapping]))

    def filled(self, keys: Sequence[str]) -> Rows:
        """Places of the rows that have a cell of any of these keys, (n,); `require` them first."""
        cells = [self.frame[self.column(key).column] for key in keys]
        return np.flatnonzero(np.logical_or.reduce([np.asarray(each.notna(), bool) for each in cells]))

    def numbers(self, keys: Sequence[str], at: Rows | None = None) -> Array:
        """Columns in SI units and slipgym's signs, (n, len(keys)); NaN where a cell is empty.

        Args:
            keys: What to read; `require` them first.
            at: Places of the rows to read, (n,); None: all.

        Raises:
            ValueError: A column is of a type that is no number, its unit is unknown, or a cell is not a
                finite number.
        """
        found = np.empty((len(self.frame) if at is None else len(at), len(keys)))
        for k, key in enumerate(keys):
            column = self.column(key)
            np.multiply(column.factor, self._read(numbers, key, at), out=found[:, k])
            if column.offset:
                found[:, k] += column.offset
        return found

    def seconds(self, key: str, at: Rows | None = None) -> tuple[Array, Column | None]:
        """A time, (n,) [s], and its column, None if its type decided the unit; otherwise as `numbers`."""
        own = self._read(times, key, at)
        if own is None:
            return self.numbers([key], at)[:, 0], self.column(key)
        column = self.columns[key]
        return own + (column.offset if column else 0.0), None

    def rows(self, at: Rows) -> Rows:
        """Rows of the file, counted from 1, at places of this table, (n,)."""
        return np.asarray(self.frame.index)[at] + 1

    def column(self, key: str) -> Column:
        """The column of a key; the unit is that of the mapping, or else of the file, or else the default.

        Raises:
            ValueError: The file states a unit that is none of the key's, the mapping neither unit nor scale.
        """
        column = self.columns[key]
        assert column is not None
        if not column.assumed:
            return column
        said, units = self.stated(column.column), units_of(key, column.position)
        unit = unit_of(key, said, column.position)
        if unit is not None:
            factor, offset = column.factor * units[unit], column.offset * units[unit]
            return replace(column, unit=unit, factor=factor, offset=offset, assumed=False)
        if said and abs(column.factor) == 1.0:  # the factor of the default unit, without a scale
            raise ValueError(
                f"{self.name}: {brief(column.column)}: {unknown('unknown unit', said[0], units)}; say it by "
                f"`{key}: {{unit: …}}` in the mapping, or its factor to {column.unit}, `{key}: {{scale: …}}`"
            )
        return column

    def stated(self, name: str) -> list[str]:
        """Texts by which a row of units, an attribute or the end of its name state the unit of a column."""
        in_name = None if self.joints else _UNIT_IN_NAME.search(name)
        said = [self.units.get(name, "").strip(), in_name[1].strip() if in_name else ""]
        return [text for text in said if not _PLACE.fullmatch(text.strip("[]()"))]

    def _read(self, reader: Any, key: str, at: Rows | None) -> Any:
        column = self.columns[key]
        assert column is not None
        try:
            cells = self.frame[column.column]
            return reader(cells if at is None else cells.iloc[at], self.comma)
        except (ValueError, TypeError, OverflowError) as error:
            raise ValueError(f"{self.name}: {brief(error, 300)}") from error


def listed(names: Sequence[Any]) -> str:
    """Names for a message, of which only the first may fit."""
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return ", ".join(brief(name) for name in names[:_SHOWN]) + more
