"""References to arguments are not counted; those to everything else are."""

import gc
import sys

import numpy as np
import pytest
from numba import float64, types

from estimator._numba.caching import njit
from estimator._numba.references import _edited

HEAD = "define i32 @f(ptr %retptr, ptr %arg.a.0, ptr %arg.a.4, ptr %arg.b.0) {\n"
COUNTS = (
    "  tail call void @NRT_incref(ptr {0})\n",
    "  call void @NRT_decref(ptr nonnull {0}), !noalias !1\n",
)


def program(*lines: str, of: str = "%arg.a.0") -> str:
    up, down = (line.format(of) for line in COUNTS)
    return HEAD + "entry:\n" + up + "".join(f"  {line}\n" for line in lines) + down + "  ret i32 0\n}"


@pytest.mark.parametrize(
    "lines",
    [
        [],
        ["%x = call i32 @other(ptr %arg.a.0, ptr %arg.a.4)"],
        ["store double 1.0, ptr %arg.a.4"],
        ["%pair = insertvalue { ptr, ptr } poison, ptr %arg.a.0, 0", "%x = call i32 %p({ ptr, ptr } %pair)"],
    ],
)
def test_counts_of_an_argument_are_removed(lines):
    edited = _edited(program(*lines))
    assert "NRT_" not in edited
    assert all(line in edited for line in lines)


def test_counts_of_either_argument_or_none_are_removed():
    choice = "%c = phi ptr [ %arg.a.0, %one ], [ null, %two ], [ %arg.b.0, %three ]"
    text = program(choice, COUNTS[1].format("%c").strip())
    assert "NRT_" not in _edited(text)


@pytest.mark.parametrize(
    "lines",
    [
        ["store ptr %arg.a.0, ptr %retptr"],
        ["%c = select i1 %d, ptr %arg.a.0, ptr %arg.b.0", "store ptr %c, ptr %retptr"],
        ["%pair = insertvalue { ptr, ptr } poison, ptr %arg.a.0, 0", "store { ptr, ptr } %pair, ptr %retptr"],
        ["call void @NRT_decref(ptr align 8 %arg.a.0)"],
        ["%y = load ptr, ptr %arg.a.4", COUNTS[1].format("%y").strip()],
        [
            "%y = call ptr @NRT_MemInfo_alloc_aligned(i64 8)",
            "%c = phi ptr [ %arg.a.0, %one ], [ %y, %two ]",
            COUNTS[1].format("%c").strip(),
        ],
    ],
)
def test_a_function_that_keeps_an_argument_stays_as_it_is(lines):
    text = program(*lines)
    assert _edited(text) == text


def test_counts_of_new_memory_stay():
    lines = "%y = call ptr @NRT_MemInfo_alloc_aligned(i64 8)", COUNTS[1].format("%y").strip()
    edited = _edited(program(*lines))
    assert edited.count("NRT_decref") == 1
    assert "NRT_incref" not in edited


@njit
def total(values: np.ndarray, twice: np.ndarray) -> float:
    result = 0.0
    for i in range(values.shape[0]):
        row = values[i]
        if row[0] > 0.0:
            row = twice[i]
        for j in range(row.shape[0]):
            result += row[j]
    return result


@njit
def tail(values: np.ndarray, new: bool) -> np.ndarray:
    if new:
        return np.ones(3)
    return values[1:]


MATRIX = types.Array(float64, 2, "C")


def test_a_program_of_views_counts_nothing():
    values, twice = np.arange(6.0).reshape(2, 3), np.ones((2, 3))
    total._cache.disable()  # a stored program has no text
    total.compile((MATRIX, MATRIX))
    before = sys.getrefcount(values)
    assert total(values, twice) == 0.0 + 1.0 + 2.0 + 3.0
    assert sys.getrefcount(values) == before
    result = total.overloads[(MATRIX, MATRIX)]
    text = result.library.get_llvm_str()
    body = text.split(f"@{result.fndesc.llvm_func_name}(", 1)[1].split("\n}", 1)[0]
    assert "NRT_" not in body


def test_a_returned_view_keeps_its_array_alive():
    values = np.arange(1000.0)
    before = sys.getrefcount(values)
    views = [tail(values, False) for _ in range(50)]
    assert sys.getrefcount(values) == before + 50
    del values
    gc.collect()
    assert all(view[-1] == 999.0 for view in views)
    assert tail(views[0], True).tolist() == [1.0, 1.0, 1.0]
