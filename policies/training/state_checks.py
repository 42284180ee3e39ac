"""Checks what a checkpoint holds of the learner, before anything of it is used."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np

_WORDS = 624
"""Of the state of a Mersenne twister."""
FAULTS = (
    *(KeyError, IndexError, TypeError, ValueError, AttributeError),
    *(RuntimeError, ArithmeticError, AssertionError, MemoryError),
)
"""What code raises that reads a tree of another shape than it wrote."""


@contextmanager
def fits(what: str) -> Iterator[None]:
    """Turn whatever a state of another shape raises into one ValueError.

    Args:
        what: The state, for the message.
    """
    try:
        yield
    except FAULTS as error:
        message = str(error).partition("\n")[0]
        raise ValueError(f"{what} does not fit this run: {type(error).__name__}: {message:.200}") from error


def check_counters(counters: Mapping[str, Any], names: tuple[str, ...]) -> None:
    """Raise ValueError unless these are the counters of a learner."""
    if set(counters) != set(names) or not all(type(value) in (int, float) for value in counters.values()):
        raise ValueError(f"counters must be numbers by the names {', '.join(names)}")


def check_array(name: str, given: Any, shape: tuple[int, ...], kinds: str = "f") -> None:
    """Raise ValueError unless this is an array of such a shape and kind of numbers, all finite.

    Args:
        name: Its name, for messages.
        given: The array.
        shape: The shape.
        kinds: Letters of numpy's kinds of dtypes.
    """
    if not isinstance(given, np.ndarray) or given.shape != shape or given.dtype.kind not in kinds:
        raise ValueError(f"{name} must be an array {shape}")
    if not np.isfinite(given).all():
        raise ValueError(f"{name} holds a number that is not finite")


def check_twister(given: Any) -> None:
    """Raise ValueError unless this is a state of numpy's Mersenne twister: numpy checks no position in it."""
    kind, words, position, *_ = given
    if kind != "MT19937" or not isinstance(words, np.ndarray) or words.shape != (_WORDS,):
        raise ValueError("generators.numpy is no state of a Mersenne twister")
    if type(position) is not int or not 0 <= position <= _WORDS:
        raise ValueError(f"generators.numpy: position {position!r:.40} must be from 0 to {_WORDS}")
