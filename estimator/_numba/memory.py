"""Memory for compiled functions: matrices on the stack, lines that are prefetched, arrays that are lent."""

from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

LINE = 64
"""Bytes of a cache line."""
_READ, _SECOND_LEVEL, _DATA = 0, 2, 1


def _asking(_: Any, array: Any, offset: Any) -> Any:
    """Type and code of a function that prefetches the line `offset` bytes into an array, or beyond it."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        start = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        byte, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        place = builder.gep(builder.bitcast(start, byte), [arguments[1]])
        kind = ir.FunctionType(ir.VoidType(), [byte, number, number, number])
        prefetch = builder.module.declare_intrinsic("llvm.prefetch", [byte], kind)
        builder.call(prefetch, [place, *(number(value) for value in (_READ, _SECOND_LEVEL, _DATA))])
        return context.get_dummy_value()

    return types.void(array, types.intp), generate


def _making(_: Any, rows: Any, columns: Any) -> Any:
    """Type and code of a function that makes a matrix on the stack; both numbers are literals."""
    kind = types.Array(types.float64, 2, "C")
    m, n = rows.literal_value, columns.literal_value

    def generate(context: Any, builder: Any, signature: Any, _: Any) -> Any:
        memory = cgutils.alloca_once(builder, ir.ArrayType(ir.DoubleType(), m * n))
        memory.align = LINE
        return _array(context, builder, kind, memory, (m, n), (8 * n, 8))

    return kind(rows, columns), generate


def _array(context: Any, builder: Any, kind: Any, memory: Any, shape: Any, strides: Any) -> Any:
    """An array of 8-byte numbers at an address."""
    array, whole = context.make_array(kind)(context, builder), context.get_value_type(types.intp)
    context.populate_array(
        array,
        data=builder.bitcast(memory, array.data.type),
        shape=cgutils.pack_array(builder, [whole(length) for length in shape]),
        strides=cgutils.pack_array(builder, [whole(step) for step in strides]),
        itemsize=whole(8),
        meminfo=None,
    )
    return array._getvalue()


def _reading(_: Any, record: Any, count: Any) -> Any:
    """Type and code of a function that returns the first numbers of a record; how many is a literal."""
    kind = types.Array(types.int64, 1, "C")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return _array(context, builder, kind, arguments[0], (count.literal_value,), (8,))

    return kind(record, count), generate


def without_owner(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """An array, or a tuple, of which nothing owns the arrays: numba counts no references to them."""
    if isinstance(kind, types.Array):
        array = context.make_array(kind)(context, builder, value)
        for name in ("meminfo", "parent"):
            setattr(array, name, cgutils.get_null_value(getattr(array, name).type))
        value = array._getvalue()
    elif isinstance(kind, types.BaseTuple):
        members: Any = kind
        for k, each in enumerate(members):
            part = without_owner(context, builder, each, builder.extract_value(value, k))
            value = builder.insert_value(value, part, k)
    return value


def _lending(_: Any, value: Any) -> Any:
    """Type and code of a function that returns its argument, of which nothing owns the arrays."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return without_owner(context, builder, value, *arguments)

    return value(value), generate


ask: Any = intrinsic(_asking)
"""Prefetches the line that lies some bytes after the start of an array: `ask(array, offset)`.

The offset may lie beyond the array, where other arrays' rows follow: nothing is read.
"""
matrix: Any = intrinsic(prefer_literal=True)(_making)
"""A matrix of float64, not initialised, for the duration of a call: `matrix(rows, columns)`, both constants.

It costs no allocation, and the compiler knows that nothing else lies in its memory.
"""
words: Any = intrinsic(prefer_literal=True)(_reading)
"""The first 8-byte numbers of a record, whatever their types, as int64: `words(record, 3)`.

The compiler goes over an array several numbers at a time, and over fields one by one.
"""
lent: Any = intrinsic(_lending)
"""The same array, or tuple with arrays, for the duration of a call: `lent(value)`.

Numba counts a reference wherever a view of an array begins or ends, with an atomic operation. To what is lent
it counts none: the caller keeps the array alive, and a function must not return it.
"""
