"""Compiled functions as arguments of others, at the cost of a number.

Numba takes any compiled function as an argument, but looks at its signature in Python at every call, which
takes longer than a step of some environments.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core import cgutils
from numba.experimental.function_type import FunctionModel
from numba.extending import NativeValue, register_model, unbox

from slipgym._numba.switches import DISABLED


class Known(types.FunctionType):
    """Type of a `Pointer` in the signature of a compiled function.

    Args:
        signature: Of its arguments and its result.
    """


class Pointer:
    """A compiled function whose address was looked up once.

    Args:
        function: The function.
        signature: Of its arguments and its result; that of the `Known` in whose place it is given.
    """

    def __init__(self, function: Any, signature: Any) -> None:
        self._function = function  # the code lives as long as its function
        compiled = function.get_compile_result(signature)
        self.address: int = compiled.library.get_pointer_to_function(compiled.fndesc.llvm_cfunc_wrapper_name)


register_model(Known)(FunctionModel)


@unbox(Known)
def _unbox(kind: Any, pointer: Any, c: Any) -> NativeValue:
    number = c.pyapi.object_getattr_string(pointer, "address")
    function = cgutils.create_struct_proxy(kind)(c.context, c.builder)
    function.c_addr = c.pyapi.long_as_voidptr(number)
    function.py_addr = function.jit_addr = cgutils.get_null_value(cgutils.voidptr_t)
    c.pyapi.decref(number)
    return NativeValue(function._getvalue())


if "pointers" in DISABLED:  # numba's own way
    Known = types.FunctionType  # type: ignore[misc]

    def Pointer(function: Any, signature: Any) -> Any:
        """The function itself."""
        return function
