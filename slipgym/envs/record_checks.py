"""Checks arrays of records from outside before compiled code reads them, where no index is checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

COUNT = 2**36
"""Largest counter: 18 years of control steps; the noise of a sensor has numbers for so many samples."""


@dataclass(frozen=True)
class Rules:
    """What the records of a dtype must satisfy; flags are 0 or 1."""

    fixed: tuple[str, ...] = ()
    """Fields that no episode changes: parameters, and lengths of buffers."""
    ranges: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    """Smallest and largest value of counters and indices."""
    counters: bool = True
    """Whether whole numbers that are not listed are from 0 to `COUNT`; otherwise all are allowed."""
    free: tuple[str, ...] = ()
    """Whole numbers of which all are allowed."""
    finite: bool = True
    """Whether all other numbers are finite."""


def damaged(what: str) -> ValueError:
    """The error for a state that no environment wrote."""
    return ValueError(f"the state is damaged: {what}")


def check_array(name: str, given: Any, dtype: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Return an array if it has this dtype and shape.

    Raises:
        ValueError: It is none, or has others.
    """
    if not isinstance(given, np.ndarray):
        raise damaged(f"{name} must be an array, got {type(given).__name__}")
    if given.dtype != dtype or given.shape != shape:
        kind = "records of another kind" if given.dtype.names else given.dtype.name
        has = f"shape {given.shape}" if given.dtype == dtype else f"{kind}, shape {given.shape}"
        raise damaged(f"{name} has {has}; the environment's shape is {shape}")
    return given


def check_finite(name: str, array: np.ndarray) -> None:
    """Raise ValueError if a number is not finite."""
    if not np.isfinite(array).all():
        raise damaged(f"{name} holds a number that is not finite")


def check_between(name: str, array: np.ndarray, low: Any, high: Any) -> None:
    """Raise ValueError if a number is not from `low` to `high`, which may be arrays."""
    bad = ~((array >= low) & (array <= high))
    if bad.any():
        raise damaged(f"{name} = {array[bad].flat[0]} is out of range")


def check_flags(name: str, given: Any, n: int) -> np.ndarray:
    """Return a copy of flags (n,) bool, or raise ValueError if these are none."""
    flags = check_array(name, given, np.dtype(bool), (n,))
    check_between(name, np.ascontiguousarray(flags).view(np.uint8), 0, 1)
    return flags.copy()


def check_records(name: str, given: Any, own: np.ndarray, rules: Rules, rows: np.ndarray) -> np.ndarray:
    """Check an array of records.

    Args:
        name: Its name, for messages.
        given: The array.
        own: That of the environment, of the same dtype and shape; its fixed fields count.
        rules: What must be so.
        rows: Rows that count, (n,) bool.

    Returns:
        The rows that count.

    Raises:
        ValueError: Something is not so; the message names array and field.
    """
    array = check_array(name, given, own.dtype, own.shape)[rows]
    mine = own[rows]
    for key in own.dtype.names or ():
        values, at = array[key], f"{name}.{key}"
        kind = values.dtype.kind
        if key in rules.fixed:
            if not np.array_equal(values, mine[key], equal_nan=kind == "f"):
                raise damaged(f"{at} differs from the environment's")
        elif kind == "b":
            check_between(at, np.ascontiguousarray(values).view(np.uint8), 0, 1)
        elif kind == "f":
            if rules.finite:
                check_finite(at, values)
        elif key in rules.ranges or (rules.counters and key not in rules.free):
            check_between(at, values, *rules.ranges.get(key, (0, COUNT)))
    return array
