"""Small readings of tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
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
    return [
        dict(zip(map(str, frame.columns), row, strict=True))
        for row in frame.itertuples(index=False, name=None)
    ]


def groups(frame: pd.DataFrame, columns: Sequence[str]) -> Iterator[tuple[tuple[str, ...], pd.DataFrame]]:
    """The rows by the names in some columns, in order of appearance."""
    for key in dict.fromkeys(zip(*(map(str, frame[column]) for column in columns), strict=True)):
        yield key, where(frame, **dict(zip(columns, key, strict=True)))


def by_metric(summary: pd.DataFrame) -> Mapping[str, tuple[float, float, float]]:
    """Value and interval of each metric, of rows of a summary that hold each metric once."""
    rows = zip(*(values(summary, name) for name in ("metric", "value", "low", "high")), strict=True)
    return {str(name): (float(value), float(low), float(high)) for name, value, low, high in rows}
