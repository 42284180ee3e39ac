"""Shortcuts of numba's compiler: each computes what the original does.

They apply while a program is compiled.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from types import NoneType
from typing import Any

from numba.core import errors, ir
from numba.core.base import BaseContext
from numba.core.targetconfig import TargetConfig
from numba.core.types import Boolean, Function, Number, Record
from numba.core.types.functions import BaseFunction
from numba.core.typing import context

_compare = TargetConfig.__eq__
_variables = ir.Inst._rec_list_vars
_describe = Record.__repr__
_resolve = BaseFunction.get_call_type
_resolved: dict[Any, Any] = {}
_size = BaseContext.get_abi_sizeof
_sizes: dict[tuple[str, Any], int] = {}


@contextmanager
def quick_compiler() -> Iterator[None]:
    """Numba's compiler with the shortcuts of this file."""
    shortcuts = (
        (TargetConfig, "__eq__", _same_options),
        (TargetConfig, "__hash__", _options_hash),
        (BaseFunction, "get_call_type", _call_type),
        (ir.Inst, "_rec_list_vars", _list_variables),
        (Record, "__repr__", _record_text),
        (errors, "termcolor", _Plain),
        (BaseContext, "get_abi_sizeof", _size_of_type),
        (BaseContext, "refresh", _only_news(BaseContext.refresh)),
        (context.BaseContext, "refresh", _only_news(context.BaseContext.refresh)),
    )
    before = [getattr(owner, name) for owner, name, _ in shortcuts]
    for owner, name, shortcut in shortcuts:
        setattr(owner, name, shortcut)
    try:
        yield
    finally:
        for (owner, name, _), original in zip(shortcuts, before, strict=True):
            setattr(owner, name, original)


def _same_options(own: TargetConfig, other: object) -> bool:
    """`TargetConfig.__eq__`, which numba calls at every call of a function that it compiles."""
    if own is other:
        return True
    mine, others = own._values, getattr(other, "_values", None)
    if mine == others:
        return True
    if others is not None and type(own) is type(other) and mine.keys() == others.keys():
        return False
    return _compare(own, other)


def _options_hash(own: TargetConfig) -> int:
    """`TargetConfig.__hash__`, which depends on the names of all options alone."""
    return _options_hash_of(type(own))


@cache
def _options_hash_of(kind: type[TargetConfig]) -> int:
    return hash(tuple(sorted(kind.options)))


def _call_type(function: Any, context: Any, args: Any, kws: Any) -> Any:
    """`BaseFunction.get_call_type`, which tries all that numba knows of an operator at each of its uses."""
    if kws or type(function) is not Function or not all(isinstance(kind, Number | Boolean) for kind in args):
        return _resolve(function, context, args, kws)
    key = function, args
    if key not in _resolved:
        _resolved[key] = _resolve(function, context, args, kws)
    return _resolved[key]


_NO_VARIABLES = {str, int, float, bool, NoneType, ir.Loc, ir.Const, ir.Global, ir.FreeVar}
"""Types of values in numba's intermediate representation that hold no variable."""


def _list_variables(own: Any, value: Any) -> list[Any]:
    """`ir.Inst._rec_list_vars`, which tests all that a statement holds against abstract base classes."""
    kind = type(value)
    if kind is not dict and kind is not list and kind is not tuple:
        return _variables(own, value)
    found: list[Any] = []
    for item in value.values() if kind is dict else value:
        kind = type(item)
        if kind is ir.Var:
            found.append(item)
        elif kind not in _NO_VARIABLES:
            found += own._rec_list_vars(item)
    return found


def _record_text(own: Record) -> str:
    """`Record.__repr__`, a long text that numba makes for every function with records."""
    try:
        return own._text  # type: ignore[attr-defined]
    except AttributeError:
        own._text = text = _describe(own)  # type: ignore[attr-defined]
        return text


class _Plain:
    """Colours of numba's messages: none. It raises and catches thousands of exceptions, each coloured."""

    def _same(self, text: str) -> str:
        return text

    code = errmsg = filename = indicate = highlight = reset = _same


def _size_of_type(own: BaseContext, kind: Any) -> int:
    """`BaseContext.get_abi_sizeof`, for which LLVM reads a program with one variable each time."""
    key = str(own.target_data), kind
    if key not in _sizes:
        _sizes[key] = _size(own, kind)
    return _sizes[key]


def _only_news(refresh: Callable[[Any], None]) -> Callable[[Any], None]:
    """`refresh` of a context if there is something new, for which it looks through all registries."""

    def refreshed(own: Any) -> None:
        if getattr(own, "_refreshed_at", -1) != _declarations(own):
            refresh(own)
            own._refreshed_at = _declarations(own)

    return refreshed


def _declarations(own: Any) -> int:
    """Number of declarations in the registries of a context and of its typing context."""
    count = sum(
        len(getattr(registry, name))
        for registry, loader in own._registries.items()
        for name in loader.registry_items
    )
    return count + (_declarations(own.typing_context) if isinstance(own, BaseContext) else 0)
