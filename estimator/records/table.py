"""Reads files as columns of numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from estimator.records import arrays, messages
from estimator.records.cells import numbers, times
from estimator.records.columns import Column, Columns
from estimator.records.extras import extra
from estimator.records.record import Array, Rows
from estimator.records.separated import read_csv
from estimator.records.units import ROWS, TIME, UNITS, unit_in
from estimator.suggestions import brief, guess, unknown

TYPES = (".csv", ".csv.gz", ".parquet", ".xlsx", *arrays.TYPES, *messages.FILES)
_UNIT_IN_NAME = re.compile(r"[\[(]([^\[\]()]*)[\])]$")
_SHOWN = 40
"""Most names of columns or values in a message."""


@dataclass(frozen=True)
class Table:
    """A file and how to find things in it."""

    name: str
    """Name of the file."""
    frame: Any
    """Its pandas.DataFrame; the index counts the rows of the file from 0."""
    columns: Columns
    """The mapping."""
    units: Mapping[str, str] = field(default_factory=dict)
    """Column -> unit, where the file has a row of units."""
    comma: bool = False
    """Whether its numbers have decimal commas."""

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
        """Refuses a file that lacks a column.

        Args:
            keys: What it must hold.

        Raises:
            ValueError: One line for each that is missing, then what is there and what a mapping may hold.
        """
        there, lines = list(self.frame.columns), []
        for key in keys:
            column = self.columns[key]
            if column is not None and column.column not in there:
                what = f"{key}: no column" if key != column.column else "no column"
                line = f"{self.name}: {what} {brief(repr(column.column))}; {guess(column.column, there)}"
                lines.append(line.rstrip("; "))
        if lines:
            lines[-1] += f"{' ' if lines[-1].endswith('?') else '; '}it has: {_listed(there)}"
            keys_of_mapping = f"map other names with --columns mapping.yaml; its keys: {', '.join(UNITS)}"
            raise ValueError("\n".join([*lines, keys_of_mapping]))

    def numbers(self, keys: Sequence[str]) -> Array:
        """Columns in SI units and slipgym's signs; NaN where a cell is empty.

        Args:
            keys: What to read; `require` them first.

        Returns:
            (rows, len(keys)).

        Raises:
            ValueError: A column is of a type that is no number, its unit is unknown, or a cell is not a
                finite number.
        """
        found = np.empty((len(self.frame), len(keys)))
        for k, key in enumerate(keys):
            found[:, k] = self._column(key).factor * self._read(numbers, key)
        return found

    def seconds(self, key: str) -> tuple[Array, Column | None]:
        """A time in seconds; dates and durations have a unit of their own.

        Args:
            key: The time of forces or velocities.

        Returns:
            (rows,) [s], NaN where it is missing; its column, None if its type decided the unit.

        Raises:
            ValueError: As `numbers`.
        """
        own = self._read(times, key)
        return (self.numbers([key])[:, 0], self._column(key)) if own is None else (own, None)

    def rows(self, at: Rows) -> Rows:
        """Rows of the file, counted from 1, at places of this table, (n,)."""
        return np.asarray(self.frame.index)[at] + 1

    def _column(self, key: str) -> Column:
        """The column of a key; the unit is that of the mapping, or else of the file, or else the default."""
        column = self.columns[key]
        assert column is not None
        if not column.assumed:
            return column
        said = self.units.get(column.column, "")
        unit = unit_in(key, said) or unit_in_name(key, column.column)
        if unit is not None:
            return replace(column, unit=unit, factor=column.factor * UNITS[key][unit], assumed=False)
        if re.search(r"\w", said):
            raise ValueError(
                f"{self.name}: {brief(column.column)}: {unknown('unknown unit', said, UNITS[key])}; "
                f"say it by `{key}: {{unit: …}}` in the mapping"
            )
        return column

    def _read(self, reader: Any, key: str) -> Any:
        column = self.columns[key]
        assert column is not None
        try:
            return reader(self.frame[column.column], self.comma)
        except (ValueError, TypeError, OverflowError) as error:
            raise ValueError(f"{self.name}: {brief(error, 300)}") from error


def read_table(path: Path, columns: Columns, time: str = TIME) -> Table:
    """Reads a file.

    Args:
        path: A file of one of `TYPES`, in any case, or the folder of a ROS 2 bag.
        columns: The mapping.
        time: Key of the time of what is to be read; an array of another length than that is left out.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: It is of another type, cannot be read as what its name says, or has a column twice.
        ModuleNotFoundError: What reads it is not installed.
    """
    if not path.name.lower().endswith(TYPES) and not messages.is_bag(path):
        raise ValueError(
            f"{path.name}: unknown file type; records are {', '.join(TYPES)} and folders of ROS 2 bags; "
            "a table in another text file, once it is unpacked, may be renamed to .csv"
        )
    if not messages.is_bag(path):
        extra("estimator.plain_files").check_regular(path)
    mapped = [column.column for key in UNITS if (column := columns[key])]
    at = columns[time]
    try:
        frame, units, comma = _frame(path, {*mapped, *columns.rows}, at.column if at else time)
    except ModuleNotFoundError:
        raise
    except Exception as error:  # a damaged file makes its readers raise anything
        raise ValueError(f"{path.name}: cannot be read: {brief(error, 300)}") from error
    return table_of(path.name, frame, columns, units, comma)


def table_of(
    name: str, frame: Any, columns: Columns, units: Mapping[str, str] | None = None, comma: bool = False
) -> Table:
    """A table of a pandas.DataFrame.

    Raises:
        ValueError: It has a column twice.
    """
    mapped = [column.column for key in UNITS if (column := columns[key])]
    frame = frame.set_axis(extra("pandas").RangeIndex(len(frame)))
    _refuse_repeated(name, list(frame.columns), [*mapped, *columns.rows])
    return Table(name, frame, columns, units or {}, comma)


def _frame(path: Path, wanted: set[str], time: str) -> tuple[Any, Mapping[str, str], bool]:
    """Its pandas.DataFrame; column -> unit that the file says; whether its numbers have decimal commas."""
    kind, pandas = path.suffix.lower(), extra("pandas")
    if kind in messages.FILES or path.is_dir():
        return messages.read_messages(path, wanted), {}, False
    if kind in arrays.TYPES:
        return arrays.frame_of(arrays.read_arrays(path), time), {}, False
    if kind == ".xlsx":
        extra("openpyxl", "records")
        frame = pandas.read_excel(path, engine="openpyxl")
    elif kind == ".parquet":
        extra("pyarrow", "records")
        frame = pandas.read_parquet(path, engine="pyarrow", page_checksum_verification=True)
    else:
        return read_csv(path, wanted)
    return named_columns(frame), {}, False


def read_columns(path: Path) -> Mapping[str, Any]:
    """All columns of a file, by name; those of a file of arrays may have different lengths.

    Raises:
        FileNotFoundError, ValueError, ModuleNotFoundError: As `read_table`.
    """
    several = path.suffix.lower() in (*arrays.TYPES, *messages.FILES)
    if not several and not messages.is_bag(path):
        return read_table(path, Columns()).frame
    if several:
        extra("estimator.plain_files").check_regular(path)
    try:
        if path.suffix.lower() in arrays.TYPES:
            return arrays.read_arrays(path)
        return messages.read_messages(path, None)
    except ModuleNotFoundError:
        raise
    except Exception as error:
        raise ValueError(f"{path.name}: cannot be read: {brief(error, 300)}") from error


def unit_in_name(key: str, name: str) -> str | None:
    """The unit that the name of a column ends with, such as "Fx [N]"; None: none of the key's."""
    said = _UNIT_IN_NAME.search(name)
    return unit_in(key, said[1]) if said else None


def named_columns(frame: Any) -> Any:
    """A pandas.DataFrame with texts as names; its index is a column if it does not count rows."""
    if not isinstance(frame.index, extra("pandas").RangeIndex) or frame.index.name is not None:
        frame = frame.reset_index(allow_duplicates=True)
    return frame.set_axis([str(name).strip() for name in frame.columns], axis=1)


def of_one_finger(tables: Sequence[Table], columns: Columns) -> list[Table]:
    """The rows that the mapping keeps, of each table that has its column.

    Raises:
        ValueError: No table has it, or no row has its value.
    """
    tables, number = list(tables), extra("pandas").to_numeric
    for name, value in columns.rows.items():
        having = [k for k, table in enumerate(tables) if name in table.frame.columns]
        if not having:
            there = _listed(tables[0].frame.columns)
            raise ValueError(f"{tables[0].name}: {ROWS}: no column {brief(repr(name))}; it has: {there}")
        for k in having:
            text = tables[k].frame[name].astype(object).map(str).str.strip()
            same = number(text, errors="coerce") == number(str(value), errors="coerce")
            frame = tables[k].frame[np.asarray(same | (text == str(value).strip()), bool)]
            if frame.empty:
                found = f"no row has {brief(name)} = {brief(value)}; it has: {_listed(text.unique())}"
                raise ValueError(f"{tables[k].name}: {found}")
            tables[k] = replace(tables[k], frame=frame)
    return tables


def _listed(names: Sequence[Any]) -> str:
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return ", ".join(brief(name) for name in names[:_SHOWN]) + more


def _refuse_repeated(source: str, names: list[str], columns: Sequence[str]) -> None:
    """Refuses a header that has a column twice that the mapping reads."""
    for column in columns:
        if names.count(column) > 1:
            places = [str(k) for k, name in enumerate(names, start=1) if name == column]
            raise ValueError(
                f"{source}: {brief(repr(column))} is the name of columns {' and '.join(places[:5])}; "
                "rename or remove all but one"
            )
