"""Borrowed arrays are the same memory, and nothing counts them."""

import sys

import numpy as np
import pytest
from numba import njit
from numba.core.unsafe.refcount import get_refcount

from slipgym._numba.borrowing import borrowed
from slipgym._numba.compiled import compiled


@compiled
def double(arrays):
    first, nothing, second = borrowed(arrays)
    for i in range(first.shape[0]):
        part = first[i : i + 1]
        part[0] *= 2.0
    second[:] += first[:1]
    return nothing is None


def test_it_is_the_same_memory_and_stays_the_callers():
    double((np.ones(3), None, np.ones((2, 1))))  # compiled
    first, second = np.ones(3), np.ones((2, 1))
    counts = sys.getrefcount(first), sys.getrefcount(second)
    assert double((first, None, second))
    np.testing.assert_array_equal(first, 2.0)
    np.testing.assert_array_equal(second, 3.0)
    assert (sys.getrefcount(first), sys.getrefcount(second)) == counts


@njit
def of_the_array(array):
    before = get_refcount(array)
    views = [array[k:] for k in range(3)]
    return before, get_refcount(array), len(views)


@njit
def of_the_borrowed(array):
    (mine,) = borrowed((array,))
    before = get_refcount(array)
    views = [mine[k:] for k in range(3)]
    return before, get_refcount(array), len(views)


@pytest.mark.parametrize(("function", "more"), [(of_the_array, 3), (of_the_borrowed, 0)])
def test_views_are_not_counted(function, more):
    before, during, _ = function(np.zeros(3))
    assert during == before + more
