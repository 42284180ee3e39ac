"""Compiles the function of an estimator that Python calls."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from numba import from_dtype, types

from estimator._numba.caching import compiler
from estimator.estimate import ESTIMATE

# error_model="numpy": a division by zero gives inf or NaN; the kernels refuse both where it matters
_compiled = compiler(error_model="numpy", forceinline=True)


@cache
def update_signature(state: np.dtype[np.void], parameters: np.dtype[np.void]) -> Any:
    """Numba's signature of an `update_batch` for states and parameters of two dtypes."""
    rows = [types.Array(from_dtype(dtype), 1, "C") for dtype in (state, parameters, ESTIMATE)]
    matrix = types.Array(types.float64, 2, "C")
    return types.void(rows[0], rows[1], types.float64, matrix, matrix, rows[2])


def entry_point(state: np.dtype[np.void], parameters: np.dtype[np.void]) -> Callable[[Any], Any]:
    """Decorates an `update_batch(states, parameters, t, wrenches, twists, estimates)` for the dtypes of two.

    The function is compiled at import, or read from the cache, so the first call is not slow. Arguments of
    other types are a TypeError.
    """

    def decorate(function: Any) -> Any:
        dispatcher = _compiled(function)
        dispatcher.compile(update_signature(state, parameters))
        dispatcher.disable_compile()
        return dispatcher

    return decorate
