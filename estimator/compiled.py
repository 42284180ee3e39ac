"""Compiled entry points whose cache notices a change in any file of this package.

Numba stores a compiled function beside its source and compiles it again when that file changes, but not when
a function it calls changes in another file. So an entry point carries the stamp of the whole package.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numba import from_dtype, njit, types

from estimator.estimate import ESTIMATE


def _package_stamp() -> tuple[int, int]:
    """Newest modification [ns] and total size [B] of the package's sources."""
    states = [path.stat() for path in Path(__file__).parent.rglob("*.py")]
    return max(state.st_mtime_ns for state in states), sum(state.st_size for state in states)


_STAMP = _package_stamp()


def _array(dtype: Any, ndim: int) -> Any:
    return types.Array(dtype, ndim, "C")


def entry_point(state: np.dtype[np.void], parameters: np.dtype[np.void]) -> Callable[[Any], Any]:
    """Decorates an `update_batch(states, parameters, t, wrenches, twists, estimates)`.

    It is compiled at import, or read from the cache: no first call is slow. Other types are a TypeError.

    Args:
        state: The dtype of a state.
        parameters: The dtype of a parameter set.
    """
    rows = [_array(from_dtype(dtype), 1) for dtype in (state, parameters, ESTIMATE)]
    matrix = _array(types.float64, 2)
    signature = types.void(rows[0], rows[1], types.float64, matrix, matrix, rows[2])

    def decorate(function: Any) -> Any:
        dispatcher: Any = njit(cache=True)(function)
        # numba offers no public way to widen the stamp; a cache file with another one is rebuilt
        dispatcher._cache._cache_file._source_stamp = _STAMP
        dispatcher.compile(signature)
        dispatcher.disable_compile()
        return dispatcher

    return decorate
