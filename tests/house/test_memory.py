"""Matrices on the stack of compiled functions."""

import numpy as np
from numba import njit

from estimator._numba.memory import matrix


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
