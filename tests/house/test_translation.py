"""Functions that are translated in short compute what Python does, and free what they allocate."""

import numba
import numpy as np
import pytest
from numba.core.runtime import _nrt_python, rtsys

from estimator._numba.quicker import quick_compiler

RECORD = np.dtype([("force", "f8"), ("slip", "f8", (2, 3)), ("count", "i8"), ("past", "f4", (4,))])


def compiled_in_short(function, *arguments):
    with quick_compiler():
        short = numba.njit(function)
        short.compile(tuple(map(numba.typeof, arguments)))
        short.disable_compile()
    return short


def _records(n=5):
    rows = np.zeros(n, dtype=RECORD)
    rng = np.random.default_rng(3)
    rows["force"], rows["count"] = rng.normal(size=n), np.arange(n)
    rows["slip"], rows["past"] = rng.normal(size=(n, 2, 3)), rng.normal(size=(n, 4))
    return rows


def _elements(rows, matrix, cube, i, j, k):
    row = rows[i]
    row.slip[1, j] = row.slip[-1, -2] + row.past[k] + rows[-1].slip[0, 2]
    row.past[j] = matrix[i, j] + matrix[-i - 1, -1] + matrix[i][j]
    cube[i, -1, j] += cube[-1, 0, -j - 1] + rows["force"][i] + cube[i, 0][1]
    matrix[i, 1:] = 2.5
    row.slip[0] = row.slip[1]
    rows[i - 3].past[:] = row.past[-1]
    return row.slip[1, j], rows[i].past[j], cube[i, -1, j], matrix[i].sum(), (row.slip, row.past)[0][0, 1]


def _transposed(matrix, i):
    matrix.T[1, i] += matrix[:, ::2][i, -1] + matrix[::-1][0, 0]
    return matrix.T[-1, i], matrix[i, 1]


def _unsigned(values, i):
    total = 0.0
    for k in range(np.uint64(3)):
        total += values[k] + values[np.uint8(i)] + values[np.int32(-i)]
    return total


@pytest.mark.parametrize("i", [0, 1, 4])
@pytest.mark.parametrize("j", [0, 2])
def test_elements_are_found_at_all_kinds_of_indices(i, j):
    matrix, cube = np.arange(20.0).reshape(5, 4), np.arange(30.0).reshape(5, 2, 3)
    expected = _records().view(np.recarray), matrix.copy(), cube.copy(), i, j, 1
    found = _records(), matrix.copy(), cube.copy(), i, j, 1
    values = compiled_in_short(_elements, *found)(*found)
    assert values == pytest.approx(_elements(*expected))
    for one, other in zip(found[:3], expected[:3], strict=True):
        np.testing.assert_array_equal(one, other)


def test_arrays_that_are_not_contiguous_and_unsigned_indices():
    one, other = np.arange(20.0).reshape(5, 4), np.arange(20.0).reshape(5, 4)
    assert compiled_in_short(_transposed, one, 3)(one, 3) == _transposed(other, 3)
    np.testing.assert_array_equal(one, other)
    values = np.arange(6.0)
    assert compiled_in_short(_unsigned, values, 2)(values, 2) == _unsigned(values, 2)


def _overwritten(n):
    kept = np.zeros(2)
    pair = (kept, (np.ones(2), 3))
    total, last = 0.0, 0.0
    for k in range(n):
        if k % 2:
            kept = np.full(3, float(k))
            pair = (kept, (np.ones(2) * k, k))
        work = np.empty(4)
        work[:] = last
        last = work[-1] + kept[0]
        total += last + pair[0][1] + pair[1][0][0] + pair[1][1]
    return total, kept


def test_variables_are_overwritten_and_arrays_freed():
    function = compiled_in_short(_overwritten, 7)
    _nrt_python.memsys_enable_stats()
    try:
        before = rtsys.get_allocation_stats()
        for _ in range(20):
            total, kept = function(7)
        expected, same = _overwritten(7)
        assert total == expected
        np.testing.assert_array_equal(kept, same)
        del kept
        after = rtsys.get_allocation_stats()
    finally:
        _nrt_python.memsys_disable_stats()
    made = after.mi_alloc - before.mi_alloc
    assert made >= 20 * 10
    assert after.mi_free - before.mi_free == made


def _closures(values):
    squares = [x * x for x in values]
    fields = np.array([1.0, 2.0, 4.0])

    def shifted(x):
        return x + fields[1]

    return shifted(sum(squares)), (values * 2.0 + fields)[2]


def _field_by_name(rows, i):
    rows[i]["force"] = 2.0 * rows["force"][i]
    return rows[i]["force"] + rows[i]["past"][1]


def test_what_the_skipped_passes_do_is_still_done_where_it_is_needed():
    values = np.array([1.0, 2.0, 3.0])
    assert compiled_in_short(_closures, values)(values) == _closures(values)
    one, other = _records(), _records()
    assert compiled_in_short(_field_by_name, one, 2)(one, 2) == _field_by_name(other, 2)


def _wrong(values):
    return values.force + 1.0


def test_an_error_names_the_place():
    with pytest.raises(numba.TypingError, match="Unknown attribute 'force'") as plain:
        numba.njit(_wrong)(np.zeros(2))
    with pytest.raises(numba.TypingError, match="typing of get attribute at ") as short:
        compiled_in_short(_wrong, np.zeros(2))
    assert str(short.value).replace("\x1b", "").count("\n") == str(plain.value).count("\n")
