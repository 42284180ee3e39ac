"""Arrays that compiled code uses without counting who refers to them.

Numba counts every view that compiled code takes of an array, with atomic operations. A step takes dozens of
views of each environment, and threads that share the arrays wait for each other's counts.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import intrinsic

from slipgym._numba.switches import DISABLED


def _borrowing(_: Any, arrays: Any) -> Any:
    """Type and code of `borrowed`."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        items = [builder.extract_value(arguments[0], k) for k in range(len(arrays))]
        for k, kind in enumerate(arrays):
            if "borrowing" in DISABLED:
                context.nrt.incref(builder, kind, items[k])
            elif isinstance(kind, types.Array):
                array = context.make_array(kind)(context, builder, items[k])
                array.meminfo = array.meminfo.type(None)
                items[k] = array._getvalue()
        return context.make_tuple(builder, signature.return_type, items)

    return arrays(arrays), generate


borrowed: Any = intrinsic(_borrowing)
"""The same tuple with arrays that are not counted, in compiled code; what is no array stays as it is.

The caller must keep the arrays alive for as long as they or their views are used."""
