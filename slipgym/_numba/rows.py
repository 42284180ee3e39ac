"""`row_of`, a row of an array that may be None, with a type of its own for either case.

In compiled code a conditional expression, or a function with two `return`s, has the type "array or None"
whenever an array is passed, and what depends on the type alone, such as the number of dimensions, is unknown.
"""

from __future__ import annotations

import numpy as np
from numba.core import types
from numba.extending import overload


def row_of(array: np.ndarray | None, i: int) -> np.ndarray | None:
    """Element i of an array along its first axis; None of None."""
    return None if array is None else array[i]


@overload(row_of)
def _row_of(array, i):  # numba compares the arguments with those of what it returns, annotations included
    if isinstance(array, types.NoneType):
        return lambda array, i: None
    return lambda array, i: array[i]
