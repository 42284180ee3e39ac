"""Asks the processor for rows of arrays before they are needed.

Thousands of environments do not fit into its own caches, and what it fetches by itself are streams, not
records of which a step needs some lines each.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from slipgym._numba.compiled import unlocked
from slipgym._numba.switches import DISABLED

LINE = 64
"""Bytes that come together."""
HEAD = 704
"""Bytes of a record that are asked for: in longer ones what most steps do not need comes last."""
_ENABLED = "prefetch" not in DISABLED
_READ, _SECOND_LEVEL, _DATA = 0, 2, 1


def _asking(_: Any, array: Any, offset: Any) -> Any:
    """Type and code of a function that asks for the line `offset` bytes into an array."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        start = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        byte, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        place = builder.gep(builder.bitcast(start, byte), [arguments[1]])
        kind = ir.FunctionType(ir.VoidType(), [byte, number, number, number])
        prefetch = builder.module.declare_intrinsic("llvm.prefetch", [byte], kind)
        builder.call(prefetch, [place, *(number(value) for value in (_READ, _SECOND_LEVEL, _DATA))])
        return context.get_dummy_value()

    return types.void(array, types.intp), generate


_ask: Any = intrinsic(_asking)


@unlocked
def fetch(array, first, stop):
    """Ask for rows of records, (n,) or (n, 2), from the first to before `stop`, as far as there are."""
    if not _ENABLED:
        return
    row = array.strides[0]
    for start in range(first * row, min(stop, array.shape[0]) * row, array.itemsize):
        for offset in range(start, start + min(HEAD, array.itemsize), LINE):
            _ask(array, offset)
