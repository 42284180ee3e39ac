"""Passes of numba's compiler that have nothing to do in most functions, and are left out there."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any

import numba
from numba.core import ir, types
from numba.core.inline_closurecall import InlineClosureCallPass
from numba.core.postproc import PostProcessor, VariableLifetime
from numba.core.transforms import canonicalize_cfg
from numba.core.typed_passes import NopythonRewrites
from numba.stencils.stencil import StencilFunc

_process = PostProcessor.run
_inline = InlineClosureCallPass.run
_rewrite = NopythonRewrites.run_pass


def _post_process(own: PostProcessor, emit_dels: bool = False, extend_lifetimes: bool = False) -> None:
    """`PostProcessor.run`, which numba calls nine times for a function, without its last part.

    Only generators and code with Python objects use what it finds: the variables at each block's entry.
    """
    code = own.func_ir
    if code.is_generator:
        _process(own, emit_dels, extend_lifetimes)
        return
    canonicalize(code)
    code.variable_lifetime = VariableLifetime(code.blocks)
    code.generator_info = None
    if emit_dels:
        own._insert_var_dels(extend_lifetimes=extend_lifetimes)


def canonicalize(code: Any) -> None:
    """Make loops have one edge back each, unless nothing has changed since they had."""
    edges = {label: block.body[-1].get_targets() for label, block in code.blocks.items()}
    if getattr(code, "_canonical", None) != edges:
        code.blocks = canonicalize_cfg(code.blocks)
        code._canonical = {label: block.body[-1].get_targets() for label, block in code.blocks.items()}


def _assigned(code: Any) -> Iterator[tuple[ir.Var, Any]]:
    """All variables and values of the assignments in a function."""
    for block in code.blocks.values():
        for statement in block.body:
            if type(statement) is ir.Assign:
                yield statement.target, statement.value


_INLINED = functools, functools.reduce, numba, numba.stencil
"""Globals of a function that may hold a call that the pass replaces."""


def _inline_closures(own: Any) -> None:
    """`InlineClosureCallPass.run` for what it may find: closures, comprehensions, `reduce` and stencils."""
    for _, value in _assigned(own.func_ir):
        kind = type(value)
        if (kind is ir.Expr and value.op in ("make_function", "build_list")) or (
            kind in (ir.Global, ir.FreeVar)
            and (isinstance(value.value, StencilFunc) or any(value.value is one for one in _INLINED))
        ):
            _inline(own)
            return


_OF_ARRAYS = {"unary", "binop", "inplace_binop", "call"}
"""Operations whose result, if it is an array, the pass may join with others in one loop."""


def _rewrite_typed(own: Any, state: Any) -> bool:
    """`NopythonRewrites.run_pass` for what it may find: fields in brackets, lists, sums of arrays."""
    kinds = state.typemap
    if any(type(kind) is types.StringLiteral for kind in kinds.values()) or any(
        value.op == "build_list" or (value.op in _OF_ARRAYS and isinstance(kinds[target.name], types.Array))
        for target, value in _assigned(state.func_ir)
        if type(value) is ir.Expr
    ):
        done: bool = _rewrite(own, state)
        return done
    return False


SHORTCUTS: tuple[tuple[Any, str, Any], ...] = (
    (PostProcessor, "run", _post_process),
    (InlineClosureCallPass, "run", _inline_closures),
    (NopythonRewrites, "run_pass", _rewrite_typed),
)
"""What is replaced: owner, name, replacement."""
