"""Turns the cells of a column into numbers, by the type of the column; a time may be a date or duration."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from estimator.records.extras import extra
from estimator.records.record import Array
from estimator.suggestions import brief

_NUMBERS = ("floating", "integer", "mixed-integer-float", "decimal", "string", "empty")
"""Kinds of columns, by the words of pandas, that hold numbers."""
_SECOND = np.timedelta64(1, "s")


def numbers(cells: Any, comma: bool = False) -> Array:
    """Floats, (n,); NaN where a cell is empty.

    Args:
        cells: A pandas.Series of numbers or texts of numbers, (n,); its index counts rows from 0.
        comma: Whether the file has decimal commas, so that a text with a point is no number.

    Raises:
        ValueError: A cell is not a finite number, an unsigned counter wraps, or the column is of another
            kind: dates, booleans, bytes, complex numbers.
    """
    kind, cells = _kind(cells)
    if kind not in _NUMBERS:
        raise ValueError(
            f"{brief(cells.name)} is of type {brief(cells.dtype)} ({kind}), but must hold numbers"
        )
    if kind == "string":
        texts = cells.str.replace(".", ",", regex=False) if comma else cells
        values = np.asarray(extra("pandas").to_numeric(texts, errors="coerce"), np.float64)
    else:
        values = cells.to_numpy(np.float64, na_value=np.nan)
    why = "is not a finite number" + " with a decimal comma, as the file has them" * comma
    _refuse((np.isnan(values) & ~np.asarray(cells.isna(), bool)) | np.isinf(values), cells, why)
    if str(cells.dtype).lower().startswith("uint"):
        there = np.flatnonzero(~np.isnan(values))
        jumps = np.abs(np.diff(values[there])) > 2.0 ** (8 * cells.dtype.itemsize - 1)
        wraps = np.zeros(len(values), bool)
        wraps[there[1:][jumps]] = True
        _refuse(wraps, cells, f"is where a counter of type {cells.dtype} wraps: write signed numbers")
    return values


def times(cells: Any, comma: bool = False) -> Array | None:
    """Seconds of a column that says its unit itself: dates with times, durations, or texts of either.

    They count from 1970 (UTC) or 0, (n,); NaN where a cell is empty. None: the column is of another kind.

    Raises:
        ValueError: A text is neither a number nor a time.
    """
    pandas, (kind, cells) = extra("pandas"), _kind(cells)
    if kind in ("datetime64", "datetime"):
        stamps = pandas.to_datetime(cells, utc=True)
    elif kind in ("timedelta64", "timedelta"):
        stamps = pandas.to_timedelta(cells)
    elif kind == "time":
        stamps = pandas.to_timedelta(cells.astype(object).map(str, na_action="ignore"))
    elif kind == "string" and pandas.to_numeric(cells.str.replace(",", "."), errors="coerce").isna().all():
        texts = cells.str.replace(",", ".", regex=False)
        stamps = pandas.to_datetime(texts, format="ISO8601", utc=True, errors="coerce")
        if stamps.isna().all():
            stamps = pandas.to_timedelta(texts, errors="coerce")
        wanted = "is neither a number, nor a time as 2024-03-31T12:00:00.001 (ISO 8601) or 12:00:00.001"
        _refuse(np.asarray(stamps.isna()) & ~np.asarray(cells.isna(), bool), cells, wanted)
    else:
        return None
    if stamps.dtype.kind == "M":
        stamps = stamps.dt.tz_localize(None)
    own = np.asarray(stamps)  # in the unit of the column, so that far years do not overflow
    return (own - own.dtype.type(0, np.datetime_data(own.dtype)[0])) / _SECOND


def _kind(cells: Any) -> tuple[str, Any]:
    """What a column holds, in a word of pandas, and the column, without categories or dictionaries."""
    infer = extra("pandas").api.types.infer_dtype
    kind = infer(cells)
    if kind in ("categorical", "unknown-array"):
        cells = cells.astype(object)
        kind = infer(cells)
    return kind, cells


def _refuse(bad: NDArray[np.bool_], cells: Any, why: str) -> None:
    if bad.any():
        k = int(np.argmax(bad))
        cell = f"{brief(cells.name)} = {brief(cells.iloc[k])}"
        raise ValueError(f"row {cells.index[k] + 1}: {cell} {why}")
