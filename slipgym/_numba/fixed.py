"""Arguments of compiled functions that stay the same between calls, and calls without numba's dispatch.

At each call from Python, numba takes every array apart and allocates a record of its owner. PyBullet's
environment passes sixty small arrays a control step. Here this is done once: the compiled function finds
what it needs at an address. The dispatch looks at the type of every argument at every call, which takes
microseconds for arrays of records.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np
from numba import typeof, types
from numba.core.registry import cpu_target
from numba.extending import NativeValue, intrinsic, models, register_model, typeof_impl, unbox

from estimator._numba.memory import without_owner
from slipgym._numba.pointers import Pointer


class FixedType(types.Type):
    """Numba type of a `Fixed`, by that of its value."""

    def __init__(self, kind: Any) -> None:
        super().__init__(name=f"Fixed({kind})")
        self.kind = kind


class Fixed(int):
    """A tuple of arrays, pointers and None as compiled functions use it; it keeps the arrays alive.

    As a number it is the address of the copy that compiled functions read.

    Args:
        value: The tuple; tuples in it are allowed. An element that is replaced later is not noticed.
        kind: Its numba type; None: found by numba, which does not know pointers.

    Attributes:
        kind: `FixedType`.

    Raises:
        TypeError: An element is of another type.
    """

    kind: FixedType
    _kept: tuple[Any, ...]

    def __new__(cls, value: tuple[Any, ...], kind: Any = None) -> Fixed:
        """Write the addresses and shapes down."""
        kind = kind or typeof(value)
        words = np.array([*_words(value)], dtype=np.int64)
        context: Any = cpu_target.target_context
        if words.nbytes != context.get_abi_sizeof(context.get_value_type(kind)):
            raise TypeError(f"the value is not laid out as {kind}")
        fixed = super().__new__(cls, words.ctypes.data)
        fixed.kind, fixed._kept = FixedType(kind), (value, words)
        return fixed

    def __reduce__(self) -> tuple[Any, ...]:
        """A copy has addresses of its own."""
        return Fixed, (self._kept[0], self.kind.kind)


def _words(value: Any) -> Iterator[int]:
    """What numba's models of these types hold; nothing owns an array, so that references are not counted."""
    if value is None:
        yield 0
    elif isinstance(value, tuple):
        for item in value:
            yield from _words(item)
    elif isinstance(value, Pointer):
        yield from (value.address, 0, 0)
    elif isinstance(value, np.ndarray) and value.flags.c_contiguous and value.flags.writeable:
        yield from (0, 0, value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides)
    else:
        raise TypeError(f"{type(value).__name__} cannot be fixed; it must be None, a pointer or an array")


def entry_point(function: Any, kinds: Sequence[Any]) -> Callable[..., Any]:
    """The machine code of a compiled function for arguments of some types, which it does not check."""
    function.compile(tuple(kinds))
    return function.overloads[tuple(kinds)].entry_point


def direct_call(function: Any, first: Sequence[Any], *kinds: Any) -> Callable[..., Any]:
    """A compiled function with its first arguments, arrays or None, to be called with more of some types."""
    return partial(entry_point(function, (*map(typeof, first), *kinds)), *first)


def _opening(_: Any, fixed: Any) -> Any:
    """Type and code of a function that returns the value of a `Fixed`."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = signature.return_type
        value = builder.load(builder.bitcast(arguments[0], context.get_value_type(kind).as_pointer()))
        return without_owner(context, builder, kind, value)

    return fixed.kind(fixed), generate


opened: Any = intrinsic(_opening)
"""Function of a `Fixed` in compiled code: its value."""


def _unbox_fixed(_: Any, fixed: Any, c: Any) -> NativeValue:
    return NativeValue(c.pyapi.long_as_voidptr(fixed))


register_model(FixedType)(models.OpaqueModel)
unbox(FixedType)(_unbox_fixed)
typeof_impl.register(Fixed)(lambda fixed, _: fixed.kind)
