"""Arguments that stay the same, which compiled functions find at an address."""

import gc
from typing import NamedTuple

import numpy as np
import pytest
from numba import float64, types

from slipgym._numba.compiled import compiled
from slipgym._numba.fixed import Fixed, direct_call, opened
from slipgym._numba.pointers import Known, Pointer

RECORD = np.dtype([("count", "i8"), ("force", "f8", 3)])
SIGNATURE = types.float64(types.float64)


class Arrays(NamedTuple):
    """Two of them."""

    plain: np.ndarray
    records: np.ndarray


@compiled
def doubled(x: float) -> float:
    """2 x."""
    return 2.0 * x


@compiled
def write(fixed, value):
    """Write to every array; returns their sizes."""
    arrays, nothing, last = opened(fixed)
    arrays.plain[1, 2] = value
    arrays.records[3].count += 1
    arrays.records[3].force[1] = value
    last[-1] = value
    return arrays.plain.size, arrays.records.shape[0], nothing is None


@compiled
def call(fixed, value):
    """The pointer's value, stored in the array."""
    array, function = opened(fixed)
    array[0] = function(value)
    return array[0]


def arrays():
    return Arrays(np.zeros((2, 3)), np.zeros(4, RECORD)), None, np.zeros(5)


def test_the_arrays_themselves_are_read_and_written():
    value = arrays()
    assert direct_call(write, (Fixed(value),), float64)(7.0) == (6, 4, True)
    (plain, records), _, last = value
    np.testing.assert_array_equal(plain, [[0.0, 0.0, 0.0], [0.0, 0.0, 7.0]])
    assert records["count"].tolist() == [0, 0, 0, 1]
    assert records["force"][3].tolist() == [0.0, 7.0, 0.0]
    assert last.tolist() == [0.0, 0.0, 0.0, 0.0, 7.0]


def test_arrays_that_nothing_else_refers_to_stay_alive():
    function = direct_call(write, (Fixed(arrays()),), float64)
    gc.collect()
    rest = [np.full(5, np.nan) for _ in range(100)]
    assert all(function(1.0) == (6, 4, True) for _ in range(100))
    assert np.isnan(rest).all()


def test_functions_are_called_by_their_addresses():
    doubled.compile(SIGNATURE)
    kind = types.Tuple([types.Array(types.float64, 1, "C"), Known(SIGNATURE)])
    array = np.zeros(2)
    fixed = Fixed((array, Pointer(doubled, SIGNATURE)), kind)
    assert direct_call(call, (fixed,), float64)(3.0) == 6.0
    assert array.tolist() == [6.0, 0.0]


@pytest.mark.parametrize("value", [np.zeros(6)[::2], np.broadcast_to(1.0, 3), [1.0], 2])
def test_other_values_are_refused(value):
    with pytest.raises(TypeError, match="cannot be fixed"):
        Fixed((value,), types.Tuple([types.Array(types.float64, 1, "C")]))


def test_a_type_of_another_layout_is_refused():
    with pytest.raises(TypeError, match="laid out"):
        Fixed((np.zeros(3),), types.Tuple([types.Array(types.float64, 2, "C")]))
