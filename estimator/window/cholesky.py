"""Solves the normal equations of the fit: Cholesky factor, substitution and inverse, in place."""

import math

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.window.layout import STATES


@njit(error_model="numpy")
def factor(a):
    """Replaces the lower triangle of a (16, 16) by its Cholesky factor; False if it has none."""
    for i in range(STATES):
        for j in range(i + 1):
            rest = a[i, j]
            for k in range(j):
                rest -= a[i, k] * a[j, k]
            if i > j:
                a[i, j] = rest / a[j, j]
            elif rest > 0.0:
                a[i, i] = math.sqrt(rest)
            else:
                return False
    return True


@njit(error_model="numpy")
def substitute(a, g):
    """Replaces g (16,) by the solution of L L' x = g."""
    for i in range(STATES):
        for k in range(i):
            g[i] -= a[i, k] * g[k]
        g[i] /= a[i, i]
    for i in range(STATES - 1, -1, -1):
        for k in range(i + 1, STATES):
            g[i] -= a[k, i] * g[k]
        g[i] /= a[i, i]


@njit(error_model="numpy")
def invert(a, inverse, factor_of_all):
    """Writes factor_of_all (L L')^-1 into a matrix (16, 16)."""
    column = matrix(1, STATES)[0]
    for j in range(STATES):  # a column is zero above j, and the result is symmetric
        for i in range(j, STATES):
            rest = factor_of_all if i == j else 0.0
            for k in range(j, i):
                rest -= a[i, k] * column[k]
            column[i] = rest / a[i, i]
        for i in range(STATES - 1, j - 1, -1):
            for k in range(i + 1, STATES):
                column[i] -= a[k, i] * column[k]
            column[i] /= a[i, i]
            inverse[i, j] = inverse[j, i] = column[i]
