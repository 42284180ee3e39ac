"""Shortcuts of numba's compiler compute what the originals do."""

import numpy as np
from numba import from_dtype
from numba.core import compiler, errors

from estimator._numba.quicker import quick_compiler


def _sample(rows, count, *rest):
    total = 0.0
    pair = (count, (count + 1, [count, 2]))
    for i in range(count):
        if rows[i].force > 0.0 and not i % 3:
            total += rows[i].force * pair[1][0]
        else:
            rows[i : i + 1]["force"][0] = max(total, min(float(i), 1.5), *rest)
    return {"total": total, "pair": pair}


def _variables():
    blocks = compiler.run_frontend(_sample).blocks
    return [
        [variable.name for variable in statement.list_vars()]
        for _, block in sorted(blocks.items())
        for statement in block.body
    ]


def test_statements_have_the_same_variables_in_the_same_order():
    expected = _variables()
    with quick_compiler():
        assert _variables() == expected
    assert sum(map(len, expected)) > 50


def test_texts_of_records_are_the_same_and_made_once():
    record = from_dtype(np.dtype([("force", "f8"), ("slip", "f8", (2, 3)), ("count", "i8")]))
    expected = repr(record)
    with quick_compiler():
        assert repr(record) == expected
        assert repr(record) is repr(record)
    assert repr(record) == expected


def test_errors_inside_are_plain_text_and_colours_come_back():
    before = errors.termcolor
    with quick_compiler():
        error = errors.TypingError("no such function").add_context("typing of a call")
        assert str(error) == "no such function\nDuring: typing of a call"
    assert errors.termcolor is before
