"""`compiled`: numba with a cache that notices a change in anything that a function uses.

A division by zero gives an infinity or a NaN, as in numpy, and not an exception: the check would keep
loops from running on several elements at once. Functions are compiled into their callers.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, ParamSpec, Protocol, TypeVar

from estimator._numba.caching import compiler
from estimator._numba.linking import resting
from slipgym._numba.switches import DISABLED

P = ParamSpec("P")
R = TypeVar("R")


class Decorator(Protocol):
    """Compiles a function; type checkers see its own signature."""

    def __call__(self, function: Callable[P, R], /) -> Callable[P, R]:
        """The compiled function."""
        ...


def _decorator(**options: Any) -> Decorator:
    """`estimator._numba.caching.compiler` with programs of their own for each set of switches."""
    return compiler(tuple(sorted(DISABLED)), error_model="numpy", **options)


compiled = _decorator(forceinline=True, fastmath=False)
"""Compiles a function on its first call.

`fastmath` is given, for a function that does not give it inherits it from the function whose compilation
compiles it first: results would depend on what was compiled before."""
unlocked = _decorator(nogil=True, forceinline=True, fastmath=False)
"""`compiled` for functions that several threads run at the same time: it releases Python's lock."""
compiled_call = _decorator(forceinline=False, fastmath=False)
"""`compiled` for a large function that few callers need: it is called, not copied into them."""
compiled_sum = _decorator(fastmath={"reassoc"})
"""For loops that sum: additions may be reordered, so that the loop computes several elements at once.

The order is fixed when the function is compiled, so that equal input gives equal bits; a processor with other
vector instructions may round differently. Functions that it calls keep the order of their operations."""
inlined_sum = _decorator(forceinline=True, fastmath={"reassoc"})
"""`compiled_sum` as a part of its caller, in which arguments that are literals simplify the loop."""


@contextmanager
def patience(what: str, after: float = 2.0) -> Iterator[None]:
    """Say on stderr why it takes so long, if it does: what is not in the cache has to be compiled.

    Args:
        what: What is compiled.
        after: Time until the message [s].
    """
    message = f"slipgym: compiling {what}; once on this machine, for up to a minute\n"
    timer = threading.Timer(after, sys.stderr.write, (message,))
    timer.daemon = True
    timer.start()
    try:
        with resting():
            yield
    finally:
        timer.cancel()
