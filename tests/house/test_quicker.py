"""Shortcuts of numba's compiler compute what the originals do."""

import functools
import gc
import math

import llvmlite.ir
import numba
import numpy as np
import pytest
from numba import from_dtype
from numba.core import base, compiler, errors, lowering, types
from numba.core.registry import cpu_target
from numba.extending import intrinsic, overload

from estimator._numba.caching import njit
from estimator._numba.linking import MANY, resting
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


def test_sizes_of_types_are_the_same():
    target = cpu_target.target_context
    kinds = [types.float64, types.boolean, types.Array(types.float64, 2, "C"), types.UniTuple(types.int8, 3)]
    values = [target.get_value_type(kind) for kind in kinds]
    expected = [target.get_abi_sizeof(value) for value in values]
    assert len({*expected}) == len(kinds)
    with quick_compiler():
        assert [target.get_abi_sizeof(value) for value in (*values, *values)] == [*expected, *expected]


def test_what_is_declared_while_programs_are_compiled_is_found():
    @njit
    def earlier(x):
        return x + 1.0

    assert earlier(1.0) == 2.0

    def _double(_, x):
        def generate(context, builder, signature, arguments):
            return builder.fadd(arguments[0], arguments[0])

        return x(x), generate

    double = intrinsic(_double)

    def tenfold(x):
        raise NotImplementedError

    @overload(tenfold)
    def _(x):
        return lambda x: 10.0 * x

    @njit
    def later(x):
        return double(x) + tenfold(x) + earlier(x)

    assert later(2.0) == 4.0 + 20.0 + 3.0
    assert numba.njit(lambda x: double(x) + tenfold(x))(2.0) == 24.0


def _placed(x, *, loc=None):
    return x, loc


def _unplaced(x):
    loc = x
    return loc


_renamed = functools.wraps(_placed)(lambda *x, **y: _placed(*x, **y))


@pytest.mark.parametrize("function", [_placed, _unplaced, _renamed, functools.partial(_placed, 1), len])
def test_whether_a_function_takes_a_place_is_found(function):
    with quick_compiler():
        found = base._has_loc(function)
    assert found == base._has_loc(function) == (function not in (_unplaced, len))


@pytest.mark.parametrize(
    "value", [np, math.sin, len, float, np.float32, 1.5, -0.0, True, 3, 2**40, "a", np.add]
)
def test_types_of_values_are_the_same(value):
    context = cpu_target.typing_context
    context.refresh()
    expected = context.resolve_value_type(value), lowering._lit_or_omitted(value)
    with quick_compiler():
        for _ in range(2):
            assert (context.resolve_value_type(value), lowering._lit_or_omitted(value)) == expected


def test_a_text_for_llvm_is_the_same():
    def text():
        module = llvmlite.ir.Module("m")
        number = llvmlite.ir.DoubleType()
        function = llvmlite.ir.Function(module, llvmlite.ir.FunctionType(number, [number, number]), "f")
        builder = llvmlite.ir.IRBuilder(function.append_basic_block("entry block"))
        one, other = function.args
        place = builder.alloca(number, name="x")
        with builder.if_else(builder.fcmp_ordered("<", one, other)) as (then, otherwise):
            for branch, value in ((then, one), (otherwise, other)):
                with branch:
                    builder.store(builder.fadd(value, one, name="x", flags=["fast"]), place)
        builder.ret(builder.fmul(builder.load(place, name="x"), other))
        return str(module)

    expected = text()
    with quick_compiler():
        assert text() == expected
    assert expected.count("x.") > 5


class _Ring:
    """Garbage that only the collector finds."""

    collected = 0

    def __init__(self):
        self.own = self

    def __del__(self):
        _Ring.collected += 1


@pytest.mark.parametrize(("made", "old"), [(MANY + 1000, True), (2000, False)])
def test_much_garbage_of_the_compiler_waits_for_a_full_collection_and_little_does_not(made, old):
    gc.collect()
    _Ring.collected = 0
    with resting():
        assert not gc.isenabled()
        for _ in range(made):
            _Ring()
    assert gc.isenabled()
    young = [[] for _ in range(2000)]  # starts a small collection
    assert _Ring.collected == (0 if old else made)
    del young
    gc.collect()
    assert _Ring.collected == made
