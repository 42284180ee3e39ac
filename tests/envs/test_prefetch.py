"""Asking for memory ahead changes nothing, and is really done."""

import numpy as np
import pytest
from numba import njit

from slipgym._numba.prefetch import fetch
from slipgym.world.records import FINGER, WORLD


@pytest.mark.parametrize(("first", "stop"), [(0, 1), (2, 3), (2, 9), (7, 8)])
def test_rows_stay_as_they_are_and_there_need_not_be_any(first: int, stop: int) -> None:
    for array in (np.ones(3, WORLD), np.ones((3, 2), FINGER)):
        before = array.copy()
        fetch(array, first, stop)
        assert array.tobytes() == before.tobytes()


def test_the_processor_is_asked() -> None:
    compiled = njit(fetch.py_func)
    compiled(np.ones(3, WORLD), 0, 1)
    assert "llvm.prefetch" in next(iter(compiled.inspect_llvm().values()))
