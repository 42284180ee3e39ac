"""Shortcuts of numba's translation to LLVM's language: shorter texts of the same meaning.

Most of what numba writes moves parts of arrays between the stack and variables. What LLVM would delete is
not written here, which saves the time to write, read, link and optimise it.
"""

from __future__ import annotations

from functools import reduce
from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.lowering import Lower
from numba.core.runtime.context import NRTContext
from numba.cpython import slicing
from numba.np import arrayobj

from estimator._numba import structures

_delete = Lower.delvar
_store = Lower.storevar
_index = arrayobj.basic_indexing
_populate = arrayobj.populate_array
_pack = cgutils.pack_array
_fix, _length, _stride = slicing.fix_slice, slicing.get_slice_length, slicing.fix_stride
_counted: dict[tuple[Any, Any], bool] = {}
_LENGTH = ir.IntType(64)


def _is_counted(models: Any, kind: Any) -> bool:
    """Whether values of a type hold references that numba counts."""
    key = models, kind
    if key not in _counted:  # an array in a record is a part of it, of which numba counts nothing
        _counted[key] = type(kind) is not types.NestedArray and models[kind].contains_nrt_meminfo()
    return _counted[key]


def _counted_parts(own: NRTContext, builder: Any, kind: Any, value: Any) -> list[tuple[Any, Any]]:
    """`NRTContext.get_meminfos`, which takes a value apart to its last number; here only what is counted."""
    models = own._context.data_model_manager
    model = models[kind]
    if not _is_counted(models, kind):
        return []
    found = [(kind, model.get_nrt_meminfo(builder, value))] if model.has_nrt_meminfo() else []
    for part, getter in model.traverse(builder):
        if _is_counted(models, part):
            found += _counted_parts(own, builder, part, getter(value))
    return found


def _delete_variable(own: Lower, name: str) -> None:
    """`Lower.delvar`, which sets a variable to zero even if nothing in it is counted."""
    if own._disable_sroa_like_opt or _is_counted(own.context.data_model_manager, own.typeof(name)):
        _delete(own, name)
    elif name not in own._blk_local_varmap:
        own._singly_assigned_vars.discard(name)


def _store_variable(own: Lower, value: Any, name: str, argidx: int | None = None) -> None:
    """`Lower.storevar`, which reads a variable before it writes it even if nothing in it is counted."""
    kind = own.typeof(name)
    local = name in own._singly_assigned_vars
    if (
        argidx is not None
        or local
        or own._disable_sroa_like_opt
        or _is_counted(own.context.data_model_manager, kind)
    ):
        _store(own, value, name, argidx)
        return
    pointer = own.getvar(name)
    if value.type != pointer.type.pointee:
        raise AssertionError(f"{value.type} is stored to {name!r}, which is {pointer.type.pointee}")
    own.builder.store(value, pointer)


def _basic_indexing(
    context: Any, builder: Any, kind: Any, array: Any, index_kinds: Any, indices: Any, boundscheck: Any = None
) -> tuple[Any, list[Any], list[Any]]:
    """`basic_indexing`, which reads the whole shape and all strides to find one element."""
    whole = kind.ndim == len(indices) > 0 and all(isinstance(own, types.Integer) for own in index_kinds)
    if boundscheck or kind.layout != "C" or not whole:
        found: tuple[Any, list[Any], list[Any]] = _index(
            context, builder, kind, array, index_kinds, indices, boundscheck
        )
        return found
    shape = _Shape(builder, kind, array)
    step: Any = None
    place: Any = None
    for axis in reversed(range(kind.ndim)):
        own = index_kinds[axis]
        index = context.cast(builder, indices[axis], own, types.intp if own.signed else types.uintp)
        if own.signed and not (_is_number(index) and index.constant >= 0):
            index = slicing.fix_index(builder, index, shape[axis])
        term = index if step is None else _product(builder, index, step)
        place = term if place is None else builder.add(place, term)
        if axis:
            step = shape[axis] if step is None else _product(builder, step, shape[axis])
    return builder.gep(_field(builder, array, "data"), [place]), [], []


def _field(builder: Any, array: Any, name: str) -> Any:
    """Field of an array's record, of its value if that was not changed."""
    value = structures.given(array)
    if value is None:
        return getattr(array, name)
    return builder.extract_value(value, array._datamodel.get_field_position(name))


class _Shape:
    """Lengths of an array's axes: numbers, or read where they are needed.

    Args:
        builder: Of the translation.
        kind: Numba type of the array.
        array: Its record.
    """

    def __init__(self, builder: Any, kind: Any, array: Any) -> None:
        self._builder, self._array = builder, array
        self._known = kind.shape if type(kind) is types.NestedArray else None

    def __getitem__(self, axis: int) -> Any:
        if self._known is not None:
            return _LENGTH(self._known[axis])
        value = structures.given(self._array)
        if value is not None:
            place = self._array._datamodel.get_field_position("shape")
            return self._builder.extract_value(value, [place, axis])
        pointer = cgutils.gep_inbounds(self._builder, self._array._get_ptr_by_name("shape"), 0, axis)
        length = self._builder.load(pointer)
        arrayobj.mark_positive(self._builder, length)
        return length


def _is_number(value: Any) -> bool:
    return isinstance(value, ir.Constant) and isinstance(value.constant, int)


def _product(builder: Any, one: Any, other: Any) -> Any:
    if _is_number(one) and _is_number(other):
        return one.type(one.constant * other.constant)
    return builder.mul(one, other)


def _fix_slice(builder: Any, slice: Any, size: Any) -> None:
    """`fix_slice`, which puts the bounds of a slice in order, without a branch for negative steps."""
    if slice._fe_type.has_step:
        _fix(builder, slice, size)
        return
    nothing = size.type(0)
    for name in ("start", "stop"):
        bound = slicing.fix_index(builder, getattr(slice, name), size)
        bound = builder.select(builder.icmp_signed("<", bound, nothing), nothing, bound)
        bound = builder.select(builder.icmp_signed(">=", bound, size), size, bound)
        setattr(slice, name, bound)


def _slice_length(builder: Any, slicestruct: Any) -> Any:
    """`get_slice_length`, which divides by the step."""
    if slicestruct._fe_type.has_step:
        return _length(builder, slicestruct)
    length = builder.sub(slicestruct.stop, slicestruct.start)
    nothing = length.type(0)
    return builder.select(builder.icmp_signed("<=", length, nothing), nothing, length)


def _fix_stride(builder: Any, slice: Any, stride: Any) -> Any:
    """`fix_stride`."""
    return _stride(builder, slice, stride) if slice._fe_type.has_step else stride


def _pack_array(builder: Any, values: Any, ty: Any = None) -> Any:
    """`pack_array`, which puts numbers into an array one by one."""
    if values and all(map(_is_number, values)):
        return ir.Constant(ir.ArrayType(values[0].type, len(values)), list(values))
    return _pack(builder, values, ty)


def _populate_array(
    array: Any, data: Any, shape: Any, strides: Any, itemsize: Any, meminfo: Any, parent: Any = None
) -> Any:
    """`populate_array`, which writes a record field by field, for an array of known shape."""
    numbers = [shape, strides, itemsize]
    if meminfo is not None or parent is not None or not all(isinstance(one, ir.Constant) for one in numbers):
        return _populate(array, data, shape, strides, itemsize, meminfo, parent)
    pointer = array._getpointer()
    record = pointer.type.pointee
    lengths = [one.constant for one in shape.constant] if shape.constant else []
    count = reduce(int.__mul__, lengths, 1)
    fields = {"shape": shape, "strides": strides, "itemsize": itemsize, "nitems": _LENGTH(count)}
    names = array._datamodel._fields
    constants = [
        ir.Constant(own, ir.Undefined) if name == "data" else fields.get(name, ir.Constant(own, None))
        for name, own in zip(names, record.elements, strict=True)
    ]
    place = names.index("data")
    if data.type != record.elements[place]:
        data = array._builder.bitcast(data, record.elements[place])
    whole = array._builder.insert_value(ir.Constant(record, constants), data, place)
    array._builder.store(whole, pointer)
    return array


def _write_block(own: ir.Block, lines: list[str]) -> None:
    """`Block.descr`, which keeps the text of each instruction."""
    lines.append(f"{own._format_name()}:\n")
    for one in own.instructions:
        parts = ["  "] if isinstance(one.type, ir.VoidType) else ["  ", one.get_reference(), " = "]
        one.descr(parts)
        lines.append("".join(parts).rstrip() + "\n")


def _name_value(own: ir.values.NamedValue, name: str) -> None:
    """`NamedValue._set_name`, which calls four functions for each instruction."""
    scope = own.parent.scope
    if own.deduplicate_name:
        used, first = scope._useset, name
        while name in used:
            scope._basenamemap[first] = count = scope._basenamemap[first] + 1
            name = f"{first}.{count}"
        used.add(name)
        own._name = name
    else:
        own._name = scope.register(name)


SHORTCUTS: tuple[tuple[Any, str, Any], ...] = (
    (NRTContext, "get_meminfos", _counted_parts),
    (Lower, "delvar", _delete_variable),
    (Lower, "storevar", _store_variable),
    (arrayobj, "basic_indexing", _basic_indexing),
    (arrayobj, "populate_array", _populate_array),
    (slicing, "fix_slice", _fix_slice),
    (slicing, "get_slice_length", _slice_length),
    (slicing, "fix_stride", _fix_stride),
    (cgutils, "pack_array", _pack_array),
    (ir.Block, "descr", _write_block),
    (ir.values.NamedValue, "_set_name", _name_value),
)
"""What is replaced: owner, name, replacement."""
