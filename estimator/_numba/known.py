"""What numba has found out about types, kept: it asks for the same again at each use."""

from __future__ import annotations

import operator
from types import BuiltinFunctionType, FunctionType, ModuleType
from typing import Any

import numpy as np
from numba.core import lowering, types
from numba.core.dispatcher import Dispatcher
from numba.core.types import Function, Record
from numba.core.types.functions import BaseFunction
from numba.core.typing.context import BaseContext

_resolve = BaseFunction.get_call_type
_resolved: dict[Any, Any] = {}
_attribute = BaseContext.find_matching_getattr_template
_attributes: dict[tuple[Any, Any, str], Any] = {}
_value = BaseContext.resolve_value_type
_values: dict[Any, Any] = {}
_literal = lowering._lit_or_omitted
_literals: dict[Any, Any] = {}
_ACCESS = {operator.getitem, operator.setitem}
_ARRAYS = {types.Array, types.NestedArray}
_PLAIN = {
    *(types.Integer, types.IntegerLiteral, types.Float, types.Complex, types.Boolean, types.BooleanLiteral),
    *(types.SliceType, types.Record),
}
"""Types of arguments that decide alone what a function of numba's gives."""


def _is_plain(kind: Any) -> bool:
    own = type(kind)
    return own in _PLAIN or (own in (types.Tuple, types.UniTuple) and all(map(_is_plain, kind)))


def _call_type(function: Any, context: Any, args: Any, kws: Any) -> Any:
    """`BaseFunction.get_call_type`, which tries all that numba knows of an operator at each of its uses."""
    if kws or type(function) is not Function:
        return _resolve(function, context, args, kws)
    plain = args[1:] if function.typing_key in _ACCESS and type(args[0]) in _ARRAYS else args
    if not all(map(_is_plain, plain)):
        return _resolve(function, context, args, kws)
    key = function, args
    if key not in _resolved:
        _resolved[key] = _resolve(function, context, args, kws)
    return _resolved[key]


def _find_attribute(own: Any, kind: Any, attribute: str) -> Any:
    """`BaseContext.find_matching_getattr_template`, asked twice for each use of a field of a record."""
    if type(kind) is not Record:
        return _attribute(own, kind, attribute)
    key = own, kind, attribute
    found = _attributes.get(key)
    if found is None and (found := _attribute(own, kind, attribute)) is not None:
        _attributes[key] = found
    return found


_LASTING = {ModuleType, BuiltinFunctionType, FunctionType, type, float, bool, np.ufunc}
"""Types of values whose numba type, once there is one, stays."""


def _value_type(own: Any, value: Any) -> Any:
    """`BaseContext.resolve_value_type`, which tries all that numba knows of for each use of a global."""
    kind = type(value)
    if kind not in _LASTING:
        return vars(value)["_type"] if isinstance(value, Dispatcher) else _value(own, value)
    key = own, kind, value
    if key not in _values:
        _values[key] = _value(own, value)
    return _values[key]


_LITERAL = {int, bool, str}
"""Types of constants that are types of their own."""


def _literal_type(value: Any) -> Any:
    """`_lit_or_omitted`, which makes a type for each constant that an operation takes."""
    kind = type(value)
    if kind not in _LITERAL:
        return _literal(value)
    key = kind, value
    if key not in _literals:
        _literals[key] = _literal(value)
    return _literals[key]


SHORTCUTS: tuple[tuple[Any, str, Any], ...] = (
    (BaseFunction, "get_call_type", _call_type),
    (BaseContext, "find_matching_getattr_template", _find_attribute),
    (BaseContext, "resolve_value_type", _value_type),
    (lowering, "_lit_or_omitted", _literal_type),
)
"""What is replaced: owner, name, replacement."""
