"""The mapping of columns: names, units and signs."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from estimator.records.extras import extra
from estimator.records.units import OPTIONAL, REQUIRED, ROWS, UNITS
from estimator.suggestions import brief, unknown


@dataclass(frozen=True)
class Column:
    """One column of a file."""

    column: str
    """Its name in the file."""
    unit: str
    """Its unit, one of `UNITS` of its key."""
    factor: float
    """What its values are multiplied with to be SI in slipgym's sign."""
    assumed: bool = field(default=False, compare=False)
    """Whether nothing states the unit, so that it is the default."""


@dataclass(frozen=True)
class Columns:
    """A mapping from slipgym's names to columns.

    A key that is not given is the column of the same name, in SI units.
    """

    given: Mapping[str, Column | None] = field(default_factory=dict)
    """Key -> its column; None: leave out what the file may have under that name."""
    rows: Mapping[str, Any] = field(default_factory=dict)
    """Column of the file -> its value in the rows of this finger; empty: all rows are."""

    def __getitem__(self, key: str) -> Column | None:
        if key in self.given:
            return self.given[key]
        return Column(key, next(iter(UNITS[key])), 1.0, True)

    def needs(self, key: str) -> bool:
        """Whether a file must have the column: all that is required, and what the mapping names."""
        return self.given.get(key) is not None or key in REQUIRED


def load_columns(path: str | os.PathLike[str] | None) -> Columns:
    """Reads a mapping.

    Args:
        path: A YAML file; None for the default mapping, whose names are slipgym's own.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: It is no mapping, or holds an unknown key, unit or sign.
    """
    if path is None:
        return Columns()
    path, files = Path(path), extra("estimator.plain_files")
    values = files.parse(files.content(path), path.name)
    if not isinstance(values, dict):
        raise ValueError(f"{path.name}: must be a mapping of names to columns, such as `f_n: Fz`")
    rows = values.pop(ROWS, {})
    if not isinstance(rows, dict) or not all(
        isinstance(name, str) and isinstance(value, str | int | float) for name, value in rows.items()
    ):
        raise ValueError(
            f"{path.name}: {ROWS}: {brief(rows)} must be a column and its value in the rows of the finger, "
            f"such as `{ROWS}: {{finger: 1}}`"
        )
    rows = {name.strip(): value for name, value in rows.items()}
    return Columns({key: _column(path.name, key, value) for key, value in values.items()}, rows)


def _column(source: str, key: Any, value: Any) -> Column | None:
    if key not in UNITS:
        raise ValueError(f"{source}: {unknown('unknown key', key, (*UNITS, ROWS))}")
    if value is None and key in OPTIONAL:
        return None
    given = value if isinstance(value, dict) else {"column": value}
    for name in given:
        if name not in ("column", "unit", "sign"):
            raise ValueError(f"{source}: {key}: {unknown('unknown key', name, ('column', 'unit', 'sign'))}")
    column = given.get("column", key)
    units = UNITS[key]
    unit, sign = given.get("unit", next(iter(units))), given.get("sign", 1)
    if not isinstance(column, str) or not column:
        raise ValueError(f"{source}: {key}: {brief(repr(column))} must be the name of a column, as text")
    if not isinstance(unit, str) or unit not in units:
        raise ValueError(f"{source}: {key}: {unknown('unknown unit', unit, units)}")
    if isinstance(sign, bool) or sign not in (1, -1):
        raise ValueError(f"{source}: {key}: sign = {brief(repr(sign))} must be 1 or -1")
    return Column(column.strip(), unit, sign * units[unit], "unit" not in given)
