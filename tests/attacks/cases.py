"""Makes values, and says what came of a call: an attack makes its cases from a random generator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

ACCEPTED, REFUSED, STOPPED = "accepted", "refused", "stopped"
"""It worked; a named error refused it; FloatingPointError ended it."""


@dataclass(frozen=True)
class Attack:
    """A kind of case."""

    name: str
    """Its name."""
    case: Callable[[np.random.Generator], str]
    """Makes one case; returns an outcome, or raises what nothing explains."""
    count: int
    """Cases without `slow`."""
    allowed: tuple[str, ...]
    """Outcomes that are explained."""


REFUSALS = (ValueError, TypeError)
"""Errors that name what was refused."""


def attempt(call: Callable[[], Any], refusals: tuple[type[BaseException], ...] = REFUSALS) -> str:
    """Make a call: `ACCEPTED`, `REFUSED` or `STOPPED`; another exception is raised."""
    try:
        call()
    except FloatingPointError:
        return STOPPED
    except refusals as error:
        message = str(error)
        return REFUSED if message and len(message) < 10_000 else f"message of {len(message)} characters"
    return ACCEPTED


def value(rng: np.random.Generator, depth: int = 0) -> Any:
    """A value of any kind, often an extreme one."""
    numbers = 0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, -1e300, float("inf"), float("nan"), 1e-3, 1e3, 0.5
    kinds: list[Callable[[], Any]] = [
        lambda: numbers[rng.integers(len(numbers))],
        lambda: float(10.0 ** rng.uniform(-6, 6) * rng.choice([-1, 1])),
        lambda: int(rng.integers(-5, 200)),
        lambda: [0, 1, 2**31, 2**63, 10**400, -(2**63)][rng.integers(6)],
        lambda: [None, True, False, "", "x" * 1000, "realistic", b"x", 1j, object()][rng.integers(9)],
    ]
    if depth < 3:
        kinds += [
            lambda: [value(rng, depth + 1) for _ in range(rng.integers(4))],
            lambda: {f"k{i}": value(rng, depth + 1) for i in range(rng.integers(3))},
        ]
    return kinds[rng.integers(len(kinds))]()


def near(rng: np.random.Generator, known: Any) -> Any:
    """A value of the same kind as a known one: numbers up to ten times smaller or larger."""
    if isinstance(known, bool) or not isinstance(known, int | float | tuple | list):
        return known
    if isinstance(known, tuple | list):
        return [near(rng, each) for each in known]
    other = known * 10.0 ** rng.uniform(-1.0, 1.0)
    return round(other) if isinstance(known, int) else other


def at(values: Any, path: tuple[Any, ...]) -> Any:
    """The value at a place of nested mappings."""
    for key in path:
        values = values[key]
    return values


def leaves(values: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Places of all values in nested mappings."""
    if not isinstance(values, dict):
        return [path]
    return [place for key, inner in values.items() for place in leaves(inner, (*path, key))]


def placed(path: tuple[Any, ...], inner: Any) -> dict[Any, Any]:
    """Nested mappings that hold one value at a place."""
    for key in reversed(path):
        inner = {key: inner}
    return inner


def mutated(rng: np.random.Generator, content: bytes) -> bytes:
    """Some bytes of a content changed, removed, doubled or cut off."""
    data = bytearray(content)
    for _ in range(rng.integers(1, 4)):
        k = int(rng.integers(max(len(data), 1)))
        kind = rng.integers(5)
        if kind == 0 and data:
            data[k] ^= 1 << int(rng.integers(8))
        elif kind == 1:
            data[k : k + int(rng.integers(1, 20))] = b""
        elif kind == 2:
            data[k:k] = data[k : k + int(rng.integers(1, 50))]
        elif kind == 3:
            data[k:k] = rng.integers(0, 256, int(rng.integers(1, 5)), dtype=np.uint8).tobytes()
        else:
            del data[int(rng.integers(len(data) // 2, len(data) + 1)) :]
    return bytes(data)
