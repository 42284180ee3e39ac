"""Functions that Python calls without compiling, and functions that Python cannot call."""

import copy
import math

import numpy as np
import pytest
from numba import types

from estimator._numba.caching import njit
from estimator._numba.uncompiled import uncompiled
from estimator.limit_surface import disc_friction
from slipgym._numba.compiled import pointed
from slipgym._numba.fixed import Fixed
from slipgym._numba.pointers import Pointer


@njit
def inner(x):
    return math.sqrt(x)


@njit
def outer(x):
    return 2.0 * inner(x)


def test_nothing_is_compiled_and_the_bits_are_the_same():
    assert uncompiled(outer)(2.0) == 2.0 * math.sqrt(2.0)
    assert not outer.overloads
    assert not inner.overloads
    for ratio in (0.0, 0.3, 1.0, 7.0, math.inf):
        assert uncompiled(disc_friction)(ratio) == disc_friction(ratio)


@pointed
def add(x: float, y: float) -> float:
    return x + y


def test_a_function_that_is_called_through_pointers_refuses_calls_from_python():
    kind = types.float64(types.float64, types.float64)
    add.compile(kind)
    assert Pointer(add, kind).address
    with pytest.raises(TypeError, match="add is called through pointers only"):
        add(1.0, 2.0)


def test_a_copy_of_a_fixed_tuple_has_its_own_arrays():
    array = np.arange(3.0)
    fixed = Fixed((array, None))
    other, same = copy.deepcopy((fixed, array))
    assert int(other) != int(fixed)
    assert other.kind == fixed.kind
    assert other._kept[0][0] is same
    assert same is not array
