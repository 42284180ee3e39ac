"""Structures and calls that are translated in fewer instructions compute what Python does."""

import numba
import numpy as np
import pytest

from estimator._numba.quicker import quick_compiler


def compiled(function, **options):
    with quick_compiler():
        return numba.njit(function, **options)


def _root(x):
    if x < 0.0:
        raise ValueError("negative")
    return x**0.5


def _found(values, wanted):
    for k, value in enumerate(values):
        if value == wanted:
            return k
    return None


def in_short(function, *arguments):
    """The function's result when it and what it calls are compiled with the shortcuts."""
    with quick_compiler():
        return numba.njit(function)(*arguments)


_compiled_root, _compiled_found = numba.njit(_root), numba.njit(_found)


def _roots(values):
    total, failed = 0.0, 0
    for x in values:
        try:
            total += _compiled_root(x)
        except Exception:
            failed += 1
    return total + _compiled_root(4.0), failed


def test_errors_of_calls_are_caught_or_passed_on():
    values = np.array([4.0, -1.0, 9.0, -2.0])
    assert in_short(_roots, values) == (7.0, 2)
    with pytest.raises(ValueError, match="negative"):
        in_short(lambda x: _compiled_root(x) + 1.0, -3.0)


def _optional(values, wanted):
    place = _compiled_found(values, wanted)
    return -1 if place is None else place


@pytest.mark.parametrize(("wanted", "place"), [(2.0, 1), (7.0, -1)])
def test_a_call_may_return_nothing(wanted, place):
    assert in_short(_optional, np.array([1.0, 2.0, 3.0]), wanted) == place


def _sliced(values, i, j, k):
    part = values[i:j]
    stepped = values[i:j:k]
    whole = values[:]
    return part.sum(), part.size, stepped.sum(), stepped.size, values[i:].size, values[:j].size, whole[-1]


@pytest.mark.parametrize("i", [-9, -2, 0, 3, 9])
@pytest.mark.parametrize("j", [-9, -2, 0, 3, 9])
@pytest.mark.parametrize("function", [compiled(_sliced)])
def test_slices_have_their_bounds(i, j, function):
    values = np.arange(5.0)
    for k in (1, 2, -1, -2):
        with quick_compiler():
            found = function(values, i, j, k)
        assert found == _sliced(values, i, j, k)


def _gathered(pairs, rows, n):
    total = 0.0
    last = (0, (0.0, 1.0))
    for k, (one, other) in enumerate(zip(pairs, rows)):  # noqa: B905, numba has no strict
        last = k, (one, other[-1])
        for a in other[k % 2 :: 2]:
            total += a * last[1][0]
        while n > k and total > 3.0:
            total -= other[0] + last[1][1]
            n -= 1
    return total, last, n


def test_iterators_and_tuples_that_change_in_loops():
    pairs, rows = np.arange(4.0), np.arange(12.0).reshape(4, 3)
    assert in_short(_gathered, pairs, rows, 6) == _gathered(pairs, rows, 6)
