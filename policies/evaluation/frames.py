"""Reads small tables, and writes them for pages and terminals."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd


def values(frame: pd.DataFrame, column: str) -> np.ndarray:
    """A column as an array."""
    return np.asarray(frame[column])


def distinct(frame: pd.DataFrame, column: str) -> list[str]:
    """The names in a column, in order of appearance."""
    return list(dict.fromkeys(map(str, frame[column])))


def where(frame: pd.DataFrame, **equals: object) -> pd.DataFrame:
    """The rows whose columns have the given values."""
    keep = np.ones(len(frame), dtype=bool)
    for column, value in equals.items():
        keep &= values(frame, column) == value
    return frame.loc[keep]


def records(frame: pd.DataFrame) -> list[dict[str, Any]]:
    """The rows as plain mappings."""
    return frame.to_dict("records")  # type: ignore[return-value]


def groups(frame: pd.DataFrame, columns: Sequence[str]) -> Iterator[tuple[tuple[Any, ...], pd.DataFrame]]:
    """The rows by what stands in some columns, in order of appearance."""
    yield from frame.groupby(list(columns), sort=False)  # type: ignore[misc]


def read_table(path: Path, words: Sequence[str]) -> pd.DataFrame:
    """Reads a CSV table; some columns stay text, where nothing but "true" would turn into booleans."""
    types: Any = dict.fromkeys(words, str)
    return pd.read_csv(path, dtype=types, keep_default_na=False, na_values=[""])


def text(interval: Sequence[float], heading: str) -> str:
    """Value, low and high as words, such as "0.42 (0.40 to 0.44)"; in % where the heading says so.

    A value that is NaN is a dash.
    """
    if np.isnan(interval[0]):
        return "–"
    scale = 100.0 if heading.endswith("[%]") else 1.0
    value, low, high = (scale * number for number in interval)
    digits = 0 if scale > 1.0 else 2 if abs(value) < 10.0 else 1
    value, low, high = (round(number, digits) + 0.0 for number in (value, low, high))  # no "-0"
    if np.isnan(low) or low == high:
        return f"{value:.{digits}f}"
    return f"{value:.{digits}f} ({low:.{digits}f} to {high:.{digits}f})"


def aligned(table: pd.DataFrame) -> str:
    """A table of words in columns of even width, with a line below the headings."""
    rows = [list(map(str, row)) for row in (table.columns, *table.itertuples(index=False, name=None))]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
    return "\n".join([lines[0], "-" * max(map(len, lines)), *lines[1:]])


def markdown(table: pd.DataFrame, digits: int = 2) -> str:
    """A table as Markdown with this many digits after the point; NaN is a dash, infinity "never"."""

    def cell(value: object) -> str:
        if not isinstance(value, float):
            return str(value)
        if value == float("inf"):
            return "never"
        return "–" if value != value else f"{value:.{digits}f}".replace("-", "−")

    numbers = ["---:" if pd.api.types.is_numeric_dtype(table[name]) else "---" for name in table]
    rows = [list(map(str, table.columns)), numbers]
    rows += [[cell(value) for value in row] for row in table.astype(object).itertuples(index=False)]
    return "".join("| " + " | ".join(row) + " |\n" for row in rows)
