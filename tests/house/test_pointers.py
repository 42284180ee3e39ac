"""Compiled functions passed as addresses."""

import os
import subprocess
import sys

import pytest
from numba import float64, njit, types

from slipgym._numba.compiled import read_disabled
from slipgym._numba.pointers import Known, Pointer

SIGNATURE = types.float64(types.float64)


@njit(SIGNATURE)
def double(x: float) -> float:
    return 2.0 * x


@njit(SIGNATURE)
def square(x: float) -> float:
    return x * x


@njit
def applied(function, x: float) -> float:
    return function(x) + 1.0


def compiled():
    """What `planar_step` does: the entry point of one signature, called without numba's dispatch."""
    signature = float64(Known(SIGNATURE), float64)
    applied.compile(signature)
    return applied.overloads[signature.args].entry_point


@pytest.mark.parametrize(("function", "expected"), [(double, 7.0), (square, 10.0)])
def test_one_program_calls_whichever_function_it_is_given(function, expected):
    assert compiled()(Pointer(function, SIGNATURE), 3.0) == expected


def test_a_pointer_keeps_its_function_alive():
    pointers = [Pointer(njit(SIGNATURE)(lambda x: 3.0 * x), SIGNATURE) for _ in range(3)]
    assert [compiled()(pointer, 1.0) for pointer in pointers] == [4.0] * 3


def test_without_the_optimisation_the_result_is_the_same():
    code = (
        "import test_pointers as t; f = t.Pointer(t.square, t.SIGNATURE); "
        "assert 'address' not in vars(f); print(t.compiled()(f, 3.0))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=__file__.rpartition("/")[0],
        env={**os.environ, "SLIPGYM_NUMBA_DISABLE": "pointers"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout.strip() == "10.0", done.stderr


def test_an_unknown_optimisation_is_an_error():
    assert read_disabled(" prefetch,pointers ") == {"prefetch", "pointers"}
    assert read_disabled("") == frozenset()
    with pytest.raises(ValueError, match="'speed' must be one of pointers, prefetch"):
        read_disabled("speed")
