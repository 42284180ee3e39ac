"""Prefetches rows of arrays: asks the processor for their memory before it is needed.

The records of thousands of environments do not fit into a processor's caches, and its own prefetcher follows
streams, not records of which a step needs some lines each.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from slipgym._numba.compiled import unlocked
from slipgym._numba.switches import DISABLED

LINE = 64
"""Bytes of a cache line."""
HEAD = 704
"""Bytes of a record that are prefetched. In longer records, fields that most steps do not need come last."""
_ENABLED = "prefetch" not in DISABLED
_READ, _SECOND_LEVEL, _DATA = 0, 2, 1


def _asking(_: Any, array: Any, offset: Any) -> Any:
    """Type and code of a function that prefetches the line `offset` bytes into an array."""

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
def fetch(array: np.ndarray, first: int, stop: int) -> None:
    """Prefetch rows of records, (n,) or (n, 2), from `first` to before `stop`, as far as there are any.

    An array of the first bytes of records, (n,), stands for them.
    """
    if not _ENABLED:
        return
    row, record = array.strides[0], array.strides[array.ndim - 1]
    for start in range(first * row, min(stop, array.shape[0]) * row, record):
        for offset in range(start, start + min(HEAD, record), LINE):
            _ask(array, offset)
