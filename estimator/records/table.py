"""Reads files as columns of numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from estimator.records.columns import Columns
from estimator.records.extras import extra
from estimator.records.record import Array
from estimator.records.separated import read_csv
from estimator.records.units import UNITS
from estimator.suggestions import no_file, unknown

TYPES = (".csv", ".csv.gz", ".parquet")


@dataclass(frozen=True)
class Table:
    """A file and how to find things in it."""

    name: str
    """Name of the file."""
    frame: Any
    """Its pandas.DataFrame."""
    columns: Columns
    """The mapping."""

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
        there, lines = [str(name) for name in self.frame.columns], []
        for key in keys:
            column = self.columns[key]
            if column is not None and column.column not in there:
                what = f"{key}: no column" if key != column.column else "no column"
                lines.append(
                    f"{self.name}: " + unknown(what, column.column, there).replace("valid", "it has")
                )
        if lines:
            keys_of_mapping = f"map other names with --columns mapping.yaml; its keys: {', '.join(UNITS)}"
            raise ValueError("\n".join([*lines, keys_of_mapping]))

    def numbers(self, keys: Sequence[str]) -> Array:
        """Columns in SI units and slipgym's signs; NaN where a cell is empty.

        Args:
            keys: What to read; `require` them first.

        Returns:
            (rows, len(keys)).

        Raises:
            ValueError: A cell is not a finite number.
        """
        found = np.empty((len(self.frame), len(keys)))
        for k, key in enumerate(keys):
            column = self.columns[key]
            assert column is not None
            cells = self.frame[column.column]
            values = np.asarray(extra("pandas").to_numeric(cells, errors="coerce"), dtype=np.float64)
            bad = (np.isnan(values) & ~np.asarray(cells.isna())) | np.isinf(values)
            if bad.any():
                row = int(np.argmax(bad))
                cell = f"{column.column} = {cells.iloc[row]}"
                raise ValueError(f"{self.name}: row {row + 1}: {cell} is not a finite number")
            found[:, k] = column.factor * values
        return found


def read_table(path: Path, columns: Columns) -> Table:
    """Reads a file.

    Args:
        path: A file of one of `TYPES`.
        columns: The mapping.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: It is of another type, cannot be read as what its name says, or has a column twice.
    """
    if not path.name.endswith(TYPES):
        raise ValueError(f"{path.name}: unknown file type; records are {', '.join(TYPES)}")
    if not path.is_file():
        raise FileNotFoundError(no_file(path))
    pandas = extra("pandas")
    if path.suffix == ".parquet":
        extra("pyarrow")
    try:
        if path.suffix == ".parquet":
            frame = pandas.read_parquet(path)
            names = list(map(str, frame.columns))
        else:
            frame, names = read_csv(path)
    except (ValueError, OSError, EOFError) as error:
        raise ValueError(f"{path.name}: cannot be read: {error}") from error
    _refuse_repeated(path.name, names, columns)
    return Table(path.name, frame, columns)


def _refuse_repeated(source: str, names: list[str], columns: Columns) -> None:
    """Refuses a header that has a column twice that the mapping reads."""
    for column in filter(None, (columns[key] for key in UNITS)):
        if names.count(column.column) > 1:
            places = [str(k) for k, name in enumerate(names, start=1) if name == column.column]
            raise ValueError(
                f"{source}: {column.column!r} is the name of columns {' and '.join(places)}; "
                "rename or remove all but one"
            )
