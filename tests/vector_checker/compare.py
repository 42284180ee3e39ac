"""Nested values as environments return them: equal or not, arrays inside, spoiling them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations
from typing import Any

import numpy as np


def demand(condition: object, message: str) -> None:
    """Raise AssertionError unless a condition holds."""
    if not condition:
        raise AssertionError(message)


def difference(a: Any, b: Any, path: str = "") -> str | None:
    """Where two nested values differ first, in words; None if they are equal bit for bit."""
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        if a.keys() != b.keys():
            return f"{path or 'keys'}: {sorted(map(str, a))} and {sorted(map(str, b))}"
        parts = [(a[key], b[key], f"{path}[{key!r}]") for key in a]
    elif isinstance(a, (tuple, list)) and isinstance(b, (tuple, list)):
        if len(a) != len(b):
            return f"{path}: {len(a)} and {len(b)} items"
        parts = [(one, other, f"{path}[{k}]") for k, (one, other) in enumerate(zip(a, b, strict=True))]
    elif isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        if a.dtype != b.dtype or a.shape != b.shape:
            return f"{path}: {a.dtype} {a.shape} and {b.dtype} {b.shape}"
        if a.dtype != object:
            return None if np.array_equal(a, b, equal_nan=a.dtype.kind in "fc") else f"{path}: {a} and {b}"
        parts = [
            (one, other, f"{path}[{k}]") for k, (one, other) in enumerate(zip(a.flat, b.flat, strict=True))
        ]
    else:
        return None if type(a) is type(b) and (a == b or (a != a and b != b)) else f"{path}: {a!r} and {b!r}"
    return next((found for part in parts if (found := difference(*part))), None)


def arrays(value: Any, path: str = "") -> Iterator[tuple[str, np.ndarray]]:
    """All arrays of a nested value, with where they are."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from arrays(inner, f"{path}[{key!r}]")
    elif isinstance(value, (tuple, list)):
        for k, inner in enumerate(value):
            yield from arrays(inner, f"{path}[{k}]")
    elif isinstance(value, np.ndarray):
        yield path, value
        if value.dtype == object:
            for k, inner in enumerate(value.flat):
                yield from arrays(inner, f"{path}[{k}]")


def check_apart(where: str, value: Any) -> None:
    """Raise AssertionError if two arrays of a nested value share memory."""
    for (here, a), (there, b) in combinations(arrays(value), 2):
        demand(not np.shares_memory(a, b), f"{where}: {here} and {there} share memory")


def spoil(value: Any) -> None:
    """Overwrite all arrays of a nested value."""
    for _, array in list(arrays(value)):
        if array.flags.writeable:
            array[...] = ~array if array.dtype == bool else None if array.dtype == object else 113
