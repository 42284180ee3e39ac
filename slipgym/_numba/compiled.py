"""`compiled`: numba with a cache that notices a change in anything that a function uses.

The environment variable SLIPGYM_NUMBA_DISABLE switches optimisations of this package off: it holds names of
`OPTIMISATIONS`, separated by commas, and is read once, at import. Each set of switches has its own programs.

A division by zero gives an infinity or a NaN, as in numpy, and not an exception: the check would keep
loops from running on several elements at once. Functions are compiled into their callers.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any, ParamSpec, TypeVar

from estimator._numba.caching import compiler
from estimator._numba.folders import why_compiling
from estimator._numba.linking import Pointed, resting

P = ParamSpec("P")
R = TypeVar("R")
VARIABLE = "SLIPGYM_NUMBA_DISABLE"
OPTIMISATIONS = ("pointers", "prefetch")
"""What can be switched off: a module of this package each. Results are the same bit for bit."""


def read_disabled(value: str) -> frozenset[str]:
    """Names in a value of the environment variable.

    Raises:
        ValueError: A name is not one of `OPTIMISATIONS`.
    """
    names = frozenset(name.strip() for name in value.split(",") if name.strip())
    for name in sorted(names - set(OPTIMISATIONS)):
        raise ValueError(f"{VARIABLE}: {name!r} must be one of {', '.join(OPTIMISATIONS)}")
    return names


DISABLED = read_disabled(os.environ.get(VARIABLE, ""))
"""The optimisations that are switched off in this process."""


def _decorator(**options: Any) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """`estimator._numba.caching.compiler` with programs of their own for each set of switches.

    Type checkers see the function's own signature.
    """
    return compiler(tuple(sorted(DISABLED)), error_model="numpy", **options)


compiled = _decorator(forceinline=True, fastmath=False)
"""Compiles a function on its first call.

`fastmath` is given, for a function that does not give it inherits it from the function whose compilation
compiles it first: results would depend on what was compiled before."""
unlocked = _decorator(nogil=True, forceinline=True, fastmath=False)
"""`compiled` for functions that several threads run at the same time: it releases Python's lock."""
pointed = _decorator(kind=Pointed, nogil=True, forceinline=True, fastmath=False)
"""`unlocked` for functions that other programs call through pointers, and Python does not."""
compiled_call = _decorator(forceinline=False, fastmath=False)
"""`compiled` for a large function that few callers need: it is called, not copied into them."""
compiled_sum = _decorator(fastmath={"reassoc"})
"""For loops that sum: additions may be reordered, so that the loop computes several elements at once.

The order is fixed when the function is compiled, so that equal input gives equal bits; a processor with other
vector instructions may round differently. Functions that it calls keep the order of their operations."""
inlined_sum = _decorator(forceinline=True, fastmath={"reassoc"})
"""`compiled_sum` as a part of its caller, in which arguments that are literals simplify the loop."""


@cache
def _explain() -> None:
    """Say once in a process that the compiler runs, why, and for how long."""
    reason = why_compiling()
    sys.stderr.write(f"slipgym: compiling for this machine, once per kind of task, about a minute{reason}\n")
    sys.stderr.flush()


@contextmanager
def patience(what: str, programs: int = 1, after: float = 2.0) -> Iterator[Callable[[], None]]:
    """Say on stderr, after some time [s], why it takes so long: what is not stored has to be compiled.

    A terminal shows how many of the programs are done, too. Yields what to call after each program.
    """
    begun, done, over = time.perf_counter(), [0], threading.Event()

    def tell() -> None:
        if over.wait(after):
            return
        _explain()
        if not sys.stderr.isatty():
            return
        while not over.wait(0.2):
            bar = f"{'#' * done[0]:-<{programs}} {done[0]} of {programs}"
            sys.stderr.write(f"\rslipgym: {what}: {bar}, {time.perf_counter() - begun:.0f} s")
            sys.stderr.flush()
        sys.stderr.write("\n")

    def one_more() -> None:
        done[0] += 1

    teller = threading.Thread(target=tell, daemon=True)
    teller.start()
    try:
        with resting():
            yield one_more
    finally:
        over.set()
        teller.join()
