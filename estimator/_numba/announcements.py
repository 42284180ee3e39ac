"""What numba announces of its work, and the checks of its passes: left out where nobody listens."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from typing import Any

from numba.core import errors, event
from numba.core.compiler_machinery import PassManager, _pass_registry
from numba.core.postproc import PostProcessor

from estimator._numba.passes import canonicalize

_start, _end, _trigger = event.start_event, event.end_event, event.trigger_event
_run = PassManager._runPass
_listeners: dict[str, list[Any]] = event._registered
_NOTHING = nullcontext()
_errors: Any = errors


def _start_event(kind: str, data: Any = None) -> None:
    """`event.start_event`, called around each call of LLVM."""
    if _listeners[kind]:
        _start(kind, data)


def _end_event(kind: str, data: Any = None, exc_details: Any = None) -> None:
    """`event.end_event`."""
    if _listeners[kind]:
        _end(kind, data, exc_details)


def _trigger_event(kind: str, data: Any = None) -> AbstractContextManager[Any]:
    """`event.trigger_event`."""
    return _trigger(kind, data) if _listeners[kind] else _NOTHING


def _run_pass(own: PassManager, index: int, one: Any, state: Any) -> None:
    """`PassManager._runPass` without texts, timers, and checks of what a pass of numba's leaves."""
    if _listeners["numba:run_pass"] or own._print_before or own._print_after or own._print_wrap:
        _run(own, index, one, state)
        return
    one.analysis = own._analysis
    with _errors.new_error_context("Pass {name}", name=one.name()):
        changes = [one.run_initialization(state), one.run_pass(state), one.run_finalizer(state)]
    if _pass_registry.get(type(one)).mutates_CFG:
        if any(changes):
            PostProcessor(state.func_ir).run()
        else:
            canonicalize(state.func_ir)


def _catch_warnings(own: Any, filename: Any = None, lineno: Any = None) -> AbstractContextManager[None]:
    """`WarningsFixer.catch_warnings`, which gathers the warnings of each expression: they come at once."""
    return _NOTHING


SHORTCUTS: tuple[tuple[Any, str, Any], ...] = (
    (event, "start_event", _start_event),
    (event, "end_event", _end_event),
    (event, "trigger_event", _trigger_event),
    (PassManager, "_runPass", _run_pass),
    (_errors.WarningsFixer, "catch_warnings", _catch_warnings),
)
"""What is replaced: owner, name, replacement."""
