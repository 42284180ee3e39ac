"""Memory of compiled functions: matrices on the stack, arrays that are lent."""

import re

import numpy as np
from numba import njit

from estimator._numba.memory import lent, matrix


@njit
def _filled(n):
    first, second = matrix(2, 3), matrix(2, 3)
    for i in range(2):
        for j in range(3):
            first[i, j], second[i, j] = n + 3 * i + j, -1.0
    total = np.zeros((2, 3))
    for i in range(2):
        total[i] += first[i]
    return total, first.shape, second.sum()


def test_matrices_are_independent_and_ordered_like_those_of_numpy():
    total, shape, other = _filled(5)
    assert total.tolist() == [[5.0, 6.0, 7.0], [8.0, 9.0, 10.0]]
    assert (shape, other) == ((2, 3), -6.0)


@njit
def _swapped(arrays, n):
    """Element of an array that is found while running: references to it are counted."""
    first, second = arrays
    for _ in range(n):
        first, second = second, first
    return first[0]


@njit
def _lent(arrays, n):
    """`_swapped` of what is lent."""
    first, second = lent(arrays)
    for _ in range(n):
        first, second = second, first
    return first[0]


def _counts(function):
    """Whether a compiled function counts references."""
    return re.search(r"call .*@NRT_incref\(", "".join(function.inspect_llvm().values())) is not None


def test_references_to_what_is_lent_are_not_counted():
    arrays = np.full(2, 3.0), np.full(4, 5.0)
    assert _lent(arrays, 1) == _swapped(arrays, 1) == 5.0
    assert _counts(_swapped)
    assert not _counts(_lent)
