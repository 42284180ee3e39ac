"""Shortcuts of numba's compiler: each computes what the original does.

They apply while a program is compiled.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from numba.core.cpu import CPUContext
from numba.core.ir import Inst, Loc, Var
from numba.core.postproc import PostProcessor, VariableLifetime
from numba.core.targetconfig import TargetConfig
from numba.core.transforms import canonicalize_cfg
from numba.core.types import Boolean, Function, Number
from numba.core.types.functions import BaseFunction
from numba.core.typing.context import Context

_compare = TargetConfig.__eq__
_resolve = BaseFunction.get_call_type
_resolved: dict[Any, Any] = {}
_loaded: set[Any] = set()
_process = PostProcessor.run
_variables = Inst._rec_list_vars
_EMPTY = frozenset((str, int, float, bool, type(None), type, Loc, type(len), type(lambda: None)))
"""Types of values in numba's instructions that hold no variable."""


@contextmanager
def quick_compiler() -> Iterator[None]:
    """Numba's compiler with the shortcuts of this file."""
    shortcuts = (
        (TargetConfig, "__eq__", _same_options),
        (TargetConfig, "__hash__", _options_hash),
        (BaseFunction, "get_call_type", _call_type),
        (Inst, "_rec_list_vars", _list_variables),
        (PostProcessor, "run", _post_process),
        *((owner, "load_additional_registries", _once(owner)) for owner in (CPUContext, Context)),
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


def _list_variables(own: Inst, value: Any) -> list[Any]:
    """`Inst._rec_list_vars`, which numba calls for every part of every instruction in nine analyses."""
    kind = type(value)
    if kind is Var:
        return [value]
    if kind in _EMPTY:
        return []
    if kind is dict:
        value = value.values()
    elif kind is not tuple and kind is not list:
        return _variables(own, value)
    found = []
    for part in value:
        found += _list_variables(own, part)
    return found


def _post_process(own: PostProcessor, emit_dels: bool = False, extend_lifetimes: bool = False) -> None:
    """`PostProcessor.run`, which after each of eight passes lists the variables that live in every block.

    Only Python's object mode reads these lists. Lifetimes are computed when something asks for them.
    """
    ir = own.func_ir
    if emit_dels or ir.is_generator:
        _process(own, emit_dels, extend_lifetimes)
        return
    ir.blocks = canonicalize_cfg(ir.blocks)
    ir.variable_lifetime = VariableLifetime(ir.blocks)
    ir.generator_info = None


def _once(owner: Any) -> Any:
    """`load_additional_registries`, which numba calls whenever it finds no implementation at first.

    It registers what modules of numba define, which does not change. Extensions register elsewhere.
    """
    load = owner.load_additional_registries

    def load_once(context: Any) -> None:
        if context not in _loaded:
            load(context)
            _loaded.add(context)

    return load_once
