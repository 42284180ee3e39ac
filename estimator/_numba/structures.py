"""Shortcuts of numba's translation to LLVM's language: structures and calls in fewer instructions.

Numba keeps each structure that it takes a field of on the stack, sets it to zero twice before it writes it,
and looks after each call for all that may have happened. LLVM deletes most of it again.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from llvmlite.ir.instructions import InsertValue, StoreInstr
from numba.core import callconv
from numba.core.callconv import CPUCallConv
from numba.core.cgutils import _StructProxy

_open = _StructProxy.__init__
_pointer_by_index = _StructProxy._get_ptr_by_index
_pointer, _value, _set = _StructProxy._getpointer, _StructProxy._getvalue, _StructProxy._setvalue
_extract = ir.IRBuilder.extract_value
_propagate = CPUCallConv.return_status_propagate


def _slot(builder: Any, kind: Any) -> Any:
    """Memory on the stack."""
    with builder.goto_entry_block():
        return builder.alloca(kind)


def _make_refs(own: Any, ref: Any) -> tuple[Any, Any]:
    """`_StructProxy._make_refs`, which sets the memory to zero in the function's first block, too."""
    if ref is None:
        ref = _slot(own._builder, own._be_type)
        own._builder.store(own._be_type(None), ref)
    return ref, ref


def _start(own: Any, context: Any, builder: Any, value: Any = None, ref: Any = None) -> None:
    """`_StructProxy.__init__`, which writes a value to the stack that may be used as it is."""
    own._given = None
    if value is None or ref is not None or builder.debug_metadata is not None:
        _open(own, context, builder, value, ref)
        return
    model = context.data_model_manager[own._fe_type]
    if own._get_be_type(model) != value.type:
        _open(own, context, builder, value, ref)
        return
    own._context, own._builder, own._datamodel, own._be_type = context, builder, model, value.type
    block = builder.block
    own._given, own._place = value, (block, block.instructions[-1] if block.instructions else None)


def _settle(own: Any) -> None:
    """Write the given value to the stack, where the structure was begun."""
    value, own._given = own._given, None
    if value is None:
        return
    builder, (block, last) = own._builder, own._place
    place = _slot(builder, own._be_type)
    store: Any = StoreInstr(block, value, place)
    store.align = None
    index = 0 if last is None else block.instructions.index(last) + 1
    block.instructions.insert(index, store)
    if builder.block is block and builder._anchor >= index:
        builder._anchor += 1
    own._value = own._outer_ref = place


def given(own: Any) -> Any:
    """Value that a structure was made of, if nothing else was done with it so far; None otherwise."""
    return own._given


def _get_pointer_by_index(own: Any, index: int) -> Any:
    _settle(own)
    return _pointer_by_index(own, index)


def _get_pointer(own: Any) -> Any:
    _settle(own)
    return _pointer(own)


def _get_value(own: Any) -> Any:
    _settle(own)
    return _value(own)


def _set_value(own: Any, value: Any) -> None:
    _settle(own)
    _set(own, value)


def _extract_value(own: ir.IRBuilder, agg: Any, idx: Any, name: str = "") -> Any:
    """`IRBuilder.extract_value`, of a value that was put together before: its part."""
    path = list(idx) if isinstance(idx, (list, tuple)) else [idx]
    whole = agg
    while path:
        if type(whole) is InsertValue:
            at = list(whole.indices)
            if path[: len(at)] == at:
                whole, path = whole.value, path[len(at) :]
            elif at[: len(path)] == path:
                break
            else:
                whole = whole.aggregate
        elif type(whole) is ir.Constant and isinstance(whole.constant, (list, tuple)):
            part = whole.constant[path[0]]
            if not isinstance(part, ir.Constant):
                break
            whole, path = part, path[1:]
        else:
            break
    return _extract(own, whole, path, name) if path else whole


class _Status:
    """`callconv.Status`: how a call ended, found out where it is asked for.

    Args:
        builder: Of the translation.
        code: What the function returned.
        place: Address of the exception.
    """

    __slots__ = ("_builder", "_place", "code")

    def __init__(self, builder: Any, code: Any, place: Any) -> None:
        self._builder, self.code, self._place = builder, code, place

    def _equals(self, code: Any) -> Any:
        return self._builder.icmp_signed("==", self.code, code)

    @property
    def is_none(self) -> Any:
        return self._equals(callconv.RETCODE_NONE)

    @property
    def is_ok(self) -> Any:
        return self._builder.or_(self._equals(callconv.RETCODE_OK), self.is_none)

    @property
    def is_error(self) -> Any:
        return self._builder.not_(self.is_ok)

    @property
    def is_python_exc(self) -> Any:
        return self._equals(callconv.RETCODE_EXC)

    @property
    def is_stop_iteration(self) -> Any:
        return self._equals(callconv.RETCODE_STOPIT)

    @property
    def is_user_exc(self) -> Any:
        return self._builder.icmp_signed(">=", self.code, callconv.RETCODE_USEREXC)

    @property
    def excinfoptr(self) -> Any:
        undefined = ir.Constant(callconv.excinfo_ptr_t, ir.Undefined)
        return self._builder.select(self.is_user_exc, self._place, undefined)


def _get_return_status(own: CPUCallConv, builder: Any, code: Any, excinfoptr: Any) -> _Status:
    """`CPUCallConv._get_return_status`."""
    return _Status(builder, code, excinfoptr)


def _return_status_propagate(own: CPUCallConv, builder: Any, status: Any) -> None:
    """`CPUCallConv.return_status_propagate`, which looks for a `try` before there is one."""
    if hasattr(builder, "_CPUCallConv__eh_try_state"):
        _propagate(own, builder, status)
        return
    builder.store(status.excinfoptr, own._get_excinfo_argument(builder.function))
    own._return_errcode_raw(builder, status.code)


SHORTCUTS: tuple[tuple[Any, str, Any], ...] = (
    (_StructProxy, "__init__", _start),
    (_StructProxy, "_make_refs", _make_refs),
    (_StructProxy, "_get_ptr_by_index", _get_pointer_by_index),
    (_StructProxy, "_getpointer", _get_pointer),
    (_StructProxy, "_getvalue", _get_value),
    (_StructProxy, "_setvalue", _set_value),
    (ir.IRBuilder, "extract_value", _extract_value),
    (CPUCallConv, "_get_return_status", _get_return_status),
    (CPUCallConv, "return_status_propagate", _return_status_propagate),
)
"""What is replaced: owner, name, replacement."""
