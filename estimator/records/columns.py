"""The mapping of columns: names, units, signs, and what differs between fingers."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from estimator.records.extras import extra
from estimator.records.units import FINGERS, OPTIONAL, POSITIONS, REQUIRED, ROWS, UNITS, units_of
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
    position: bool = False
    """Whether it counts displacement, of which the velocity is the difference."""
    offset: float = 0.0
    """What is added to its values in SI."""


Wanted = Collection[str] | None
"""Names of columns to read, or what is behind a / or . of them; None: all."""


def is_wanted(name: str, wanted: Wanted) -> bool:
    """Whether a column is asked for by its name or the end of it."""
    return wanted is None or name in wanted or any(name.endswith(("/" + end, "." + end)) for end in wanted)


@dataclass(frozen=True)
class Columns:
    """A mapping from slipgym's names to columns.

    A key that is not given is the column of the same name, in SI units.
    """

    given: Mapping[str, Column | None] = field(default_factory=dict)
    """Key -> its column; None: leave out what the file may have under that name."""
    rows: Mapping[str, Any] = field(default_factory=dict)
    """Column of the file -> its value in the rows of this finger; empty: all rows are."""
    fingers: Mapping[str, Columns] = field(default_factory=dict)
    """Name of a finger -> its mapping; empty: there is one finger."""

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
    return _columns(path.name, files.parse(files.content(path), path.name))


def _columns(source: str, values: Any, shared: Columns | None = None) -> Columns:
    """A mapping, or the part of it that is a finger's own."""
    if not isinstance(values, dict):
        raise ValueError(f"{source}: must be a mapping of names to columns, such as `f_n: Fz`")
    shared, values = shared or Columns(), dict(values)
    rows, fingers = values.pop(ROWS, {}), values.pop(FINGERS, {})
    if not isinstance(rows, dict) or not all(
        isinstance(name, str) and isinstance(value, str | int | float) for name, value in rows.items()
    ):
        raise ValueError(
            f"{source}: {ROWS}: {brief(rows)} must be a column and its value in the rows of the finger, "
            f"such as `{ROWS}: {{finger: 1}}`"
        )
    given = {**shared.given, **{key: _column(source, key, value) for key, value in values.items()}}
    own = Columns(given, {**shared.rows, **{name.strip(): value for name, value in rows.items()}})
    plain = isinstance(fingers, dict) and all(re.fullmatch(r"\w[\w-]*", str(name)) for name in fingers)
    if not plain:
        raise ValueError(
            f"{source}: {FINGERS}: {brief(fingers)} must be names of fingers, each with its own columns, "
            f"such as `{FINGERS}: {{left: {{f_n: Fz1}}, right: {{f_n: Fz2}}}}`"
        )
    return replace(
        own,
        fingers={str(name): _columns(f"{source}: {name}", part, own) for name, part in fingers.items()},
    )


def _column(source: str, key: Any, value: Any) -> Column | None:
    if key not in UNITS:
        raise ValueError(f"{source}: {unknown('unknown key', key, (*UNITS, ROWS, FINGERS))}")
    if value is None and key in OPTIONAL:
        return None
    given: dict[str, Any] = value if isinstance(value, dict) else {"column": value}
    for name in given:
        if name not in _SAYS:
            raise ValueError(f"{source}: {key}: {unknown('unknown key', name, _SAYS)}")
    position = "position" in given
    if position and (key not in POSITIONS or "column" in given):
        why = f"a position is of one of {', '.join(POSITIONS)}, and takes the place of a column"
        raise ValueError(f"{source}: {key}: {why}")
    column = given["position"] if position else given.get("column", key)
    units = units_of(key, position)
    unit, sign = given.get("unit", next(iter(units))), given.get("sign", 1)
    scale, offset = given.get("scale", 1.0), given.get("offset", 0.0)
    if not isinstance(column, str) or not column:
        raise ValueError(f"{source}: {key}: {brief(repr(column))} must be the name of a column, as text")
    if not isinstance(unit, str) or unit not in units:
        raise ValueError(f"{source}: {key}: {unknown('unknown unit', unit, units)}")
    if isinstance(sign, bool) or sign not in (1, -1):
        raise ValueError(f"{source}: {key}: sign = {brief(repr(sign))} must be 1 or -1")
    for name, value in (("scale", scale), ("offset", offset)):
        number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
        if not number or (name == "scale" and value <= 0):
            kind = "a positive number" if name == "scale" else "a number"
            raise ValueError(f"{source}: {key}: {name} = {brief(repr(value))} must be {kind}")
    factor, added = sign * float(scale) * units[unit], float(offset) * units[unit]
    return Column(column.strip(), unit, factor, "unit" not in given, position, added)


_SAYS = ("column", "position", "unit", "sign", "scale", "offset")
"""What a mapping may say of a column."""
