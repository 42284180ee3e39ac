"""Shortcuts of numba's compiler: each computes what the original does.

They apply while a program is compiled.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from types import FunctionType, NoneType
from typing import Any

from numba.core import base, errors, funcdesc, ir, itanium_mangler, lowering, typeinfer
from numba.core.base import BaseContext
from numba.core.targetconfig import TargetConfig
from numba.core.types import Record
from numba.core.typing import context

from estimator._numba import announcements, known, passes, structures, translation

_compare = TargetConfig.__eq__
_variables = ir.Inst._rec_list_vars
_describe = Record.__repr__
_identifier = itanium_mangler.mangle_identifier
_name = funcdesc.default_mangler
_size = BaseContext.get_abi_sizeof
_sizes: dict[tuple[str, Any], int] = {}
_errors: Any = errors
_in_context = _errors.new_error_context


@contextmanager
def quick_compiler() -> Iterator[None]:
    """Numba's compiler with the shortcuts of this file and of those that it imports."""
    shortcuts = (
        (TargetConfig, "__eq__", _same_options),
        (TargetConfig, "__hash__", _options_hash),
        (ir.Inst, "_rec_list_vars", _list_variables),
        (Record, "__repr__", _record_text),
        (errors, "termcolor", _Plain),
        (itanium_mangler, "mangle_identifier", _short_identifier),
        (funcdesc, "default_mangler", _short_name),
        (base, "_has_loc", _has_place),
        (errors, "new_error_context", _Context),
        (lowering, "new_error_context", _Context),
        (typeinfer, "new_error_context", _Context),
        (BaseContext, "get_abi_sizeof", _size_of_type),
        (BaseContext, "refresh", _only_news(BaseContext.refresh)),
        (context.BaseContext, "refresh", _only_news(context.BaseContext.refresh)),
        *announcements.SHORTCUTS,
        *passes.SHORTCUTS,
        *known.SHORTCUTS,
        *structures.SHORTCUTS,
        *translation.SHORTCUTS,
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


_place = base._has_loc
_PLACES = {"__wrapped__", "__signature__"}
"""Attributes of a function that tell other arguments than its own."""


def _has_place(function: Any) -> bool:
    """`_has_loc`, whether a function takes an argument `loc`, asked for each operation."""
    if type(function) is not FunctionType or not _PLACES.isdisjoint(vars(function)):
        return bool(_place(function))
    code = function.__code__
    return "loc" in code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]


LONG = 200
"""Length of a type's text from which a hash stands for it in the names of functions."""


def _short_identifier(text: str, *rest: Any, **options: Any) -> str:
    """`mangle_identifier`, which puts texts of types, up to 100 kB, into the names of functions."""
    if len(text) > LONG:
        text = f"long_{hashlib.sha256(text.encode()).hexdigest()[:32]}"
    name: str = _identifier(text, *rest, **options)
    return name


SHOWN = 60
"""Characters of a function's name, with the types of its arguments, that are kept of a long one."""


def _short_name(name: str, argtypes: Any, *, abi_tags: Any = (), uid: Any = None) -> str:
    """`default_mangler`: the name of a function stands in the text of each function that calls it."""
    whole: str = _name(name, argtypes, abi_tags=abi_tags, uid=uid)
    if len(whole) <= 2 * SHOWN:
        return whole
    return f"{whole[:SHOWN]}_{hashlib.sha256(whole.encode()).hexdigest()[:32]}"


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


class _Context:
    """`new_error_context`, a generator, for what raises nothing.

    Args:
        fmt_: What is done, for the message.
        *args: For `fmt_`.
        **kwargs: Likewise.
    """

    __slots__ = ("_arguments",)

    def __init__(self, fmt_: str, *args: Any, **kwargs: Any) -> None:
        self._arguments = fmt_, args, kwargs

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: Any, error: Any, traceback: Any) -> None:
        if error is not None:
            fmt_, args, kwargs = self._arguments
            with _in_context(fmt_, *args, **kwargs):
                raise error


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
    registries = own._registries
    if getattr(own, "_count_of_declared", -1) != len(registries):
        own._count_of_declared = len(registries)
        own._declared = [
            getattr(registry, name)
            for registry, loader in registries.items()
            for name in loader.registry_items
        ]
    count = sum(map(len, own._declared))
    return count + (_declarations(own.typing_context) if isinstance(own, BaseContext) else 0)
