"""Prints arrays so that equal texts are equal bits."""

from contextlib import AbstractContextManager
from typing import Any

import numpy as np


def _bits(array: np.ndarray) -> str:
    values = array.tolist() if array.dtype.hasobject else array.tobytes().hex()
    return f"{array.dtype}{array.shape}{values}"


def exactly() -> AbstractContextManager[Any]:
    """Arrays are printed with all digits or, since numpy 2, as their bytes, which is much faster."""
    if np.lib.NumpyVersion(np.__version__) < "2.0.0":
        return np.printoptions(precision=17, floatmode="unique", threshold=10_000)
    return np.printoptions(override_repr=_bits)
