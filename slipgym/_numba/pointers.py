"""Passes compiled functions to compiled functions as bare addresses.

Numba accepts a compiled function as an argument, but then compares signatures in Python at every call,
which takes longer than a step of one planar environment.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core import cgutils
from numba.experimental.function_type import FunctionModel
from numba.extending import NativeValue, register_model, unbox

from slipgym._numba.compiled import DISABLED

_ENABLED = "pointers" not in DISABLED


class Known(types.FunctionType):
    """Numba type of a `Pointer` in the signature of a compiled function, with the signature pointed to."""


class Pointer:
    """Address of a function compiled for a signature, looked up once; at every call with `pointers` off.

    The `Known` parameter that it is passed to has the function's signature, or one whose arguments are passed
    in the same way: arrays of other records, for example.
    """

    def __init__(self, function: Any, signature: Any) -> None:
        self._function, self._signature = function, signature  # keeps the machine code alive
        if _ENABLED:
            self.address = self._found()

    def __getattr__(self, name: str) -> int:
        if name != "address":
            raise AttributeError(name)
        return self._found()

    def _found(self) -> int:
        compiled = self._function.get_compile_result(self._signature)
        return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_cfunc_wrapper_name))


def _unbox_pointer(kind: Any, pointer: Any, c: Any) -> NativeValue:
    number = c.pyapi.object_getattr_string(pointer, "address")
    function = cgutils.create_struct_proxy(kind)(c.context, c.builder)
    function.c_addr = c.pyapi.long_as_voidptr(number)
    function.py_addr = function.jit_addr = cgutils.get_null_value(cgutils.voidptr_t)
    c.pyapi.decref(number)
    return NativeValue(function._getvalue())


register_model(Known)(FunctionModel)
unbox(Known)(_unbox_pointer)
