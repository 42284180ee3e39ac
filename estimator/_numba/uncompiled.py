"""Compiled functions as Python functions, for tables made at import: nothing is compiled for them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import Any

from numba.core.dispatcher import Dispatcher


@cache
def uncompiled(function: Dispatcher) -> Callable[..., Any]:
    """The Python function of a compiled one, in which the functions that it calls are not compiled either.

    Args:
        function: The compiled function.
    """
    source: Any = function.py_func
    known = source.__globals__
    called = {
        name: known[name] for name in source.__code__.co_names if isinstance(known.get(name), Dispatcher)
    }
    plain = {name: uncompiled(value) for name, value in called.items()}
    return FunctionType(
        source.__code__, {**known, **plain}, source.__name__, source.__defaults__, source.__closure__
    )
