"""Calls of compiled functions from Python without numba's dispatch.

The dispatch looks at the type of every argument at every call, which takes microseconds for arrays of
records.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from numba import typeof


def entry_point(function: Any, kinds: Sequence[Any]) -> Callable[..., Any]:
    """The machine code of a compiled function for arguments of some types, which it does not check.

    Args:
        function: The function; it is compiled or loaded if need be.
        kinds: Types of its arguments.
    """
    function.compile(tuple(kinds))
    return function.overloads[tuple(kinds)].entry_point


def direct_call(function: Any, first: Sequence[Any], *kinds: Any) -> Callable[..., Any]:
    """A compiled function with its first arguments given, to be called with others of some types.

    Args:
        function: The function.
        first: Its first arguments: arrays, or None.
        *kinds: Types of the others.
    """
    return partial(entry_point(function, (*map(typeof, first), *kinds)), *first)
