"""Checks what a checkpoint holds of the learner against the learner itself, before anything of it is used."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np

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


def check_like(name: str, given: Any, own: Any) -> None:
    """Raise ValueError unless a tree has the shape of another one, and all its numbers are finite.

    Args:
        name: Its name, for messages.
        given: Mappings, lists, tuples, arrays, numbers and texts.
        own: The other one; None stands for any value.
    """
    if isinstance(given, np.ndarray):
        if isinstance(own, np.ndarray) and (given.shape, given.dtype.kind) != (own.shape, own.dtype.kind):
            raise ValueError(f"{name} must be an array {own.shape} of {own.dtype.name}")
        if given.dtype.kind == "f" and not np.isfinite(given).all():
            raise ValueError(f"{name} holds a number that is not finite")
    if own is not None and not _same_kind(given, own):
        raise ValueError(f"{name} = {given!r:.40} must be of the kind of {own!r:.40}")
    pairs: Any = ()
    if isinstance(given, Mapping):
        pairs = ((key, each, own[key] if own else None) for key, each in given.items())
    elif isinstance(given, list | tuple):
        pairs = ((k, each, own[k] if own else None) for k, each in enumerate(given))
    for key, each, other in pairs:
        check_like(f"{name}.{key}", each, other)


def _same_kind(given: Any, own: Any) -> bool:
    if isinstance(own, Mapping):
        return isinstance(given, Mapping) and given.keys() == own.keys()
    if isinstance(own, list | tuple):
        return type(given) is type(own) and len(given) == len(own)
    if isinstance(own, str):
        return given == own
    return type(given) is type(own) or {type(given), type(own)} == {int, float}
