"""Passes compiled functions to compiled functions as bare addresses.

Numba accepts a compiled function as an argument, but then compares signatures in Python at every call,
which takes longer than a step of one planar environment.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core import cgutils
from numba.experimental.function_type import FunctionModel, unbox_function_type
from numba.extending import NativeValue, register_model, unbox

from slipgym._numba.switches import DISABLED

_ENABLED = "pointers" not in DISABLED


class Known(types.FunctionType):
    """Numba type of a `Pointer` in the signature of a compiled function.

    Args:
        signature: Signature of the function pointed to.
    """


class Pointer:
    """Address of a compiled function, looked up once. With the optimisation off: the function itself.

    Args:
        function: The compiled function.
        signature: Its signature; that of the `Known` parameter that it is passed to.
    """

    def __new__(cls, function: Any, signature: Any) -> Any:
        """A pointer, or `function` if the optimisation is switched off."""
        return super().__new__(cls) if _ENABLED else function

    def __init__(self, function: Any, signature: Any) -> None:
        self._function = function  # keeps the machine code alive
        compiled = function.get_compile_result(signature)
        self.address: int = compiled.library.get_pointer_to_function(compiled.fndesc.llvm_cfunc_wrapper_name)


def _unbox_pointer(kind: Any, pointer: Any, c: Any) -> NativeValue:
    number = c.pyapi.object_getattr_string(pointer, "address")
    function = cgutils.create_struct_proxy(kind)(c.context, c.builder)
    function.c_addr = c.pyapi.long_as_voidptr(number)
    function.py_addr = function.jit_addr = cgutils.get_null_value(cgutils.voidptr_t)
    c.pyapi.decref(number)
    return NativeValue(function._getvalue())


register_model(Known)(FunctionModel)
unbox(Known)(_unbox_pointer if _ENABLED else unbox_function_type)
