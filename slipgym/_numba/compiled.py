"""`compiled`: numba with a cache that notices a change in any file of slipgym.

A division by zero gives an infinity or a NaN, as in numpy, and not an exception: the check would keep
loops from running on several elements at once. Functions are compiled into their callers.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from estimator._numba.caching import compiler

_HERE = Path(__file__).parents[1]

compiled = compiler(_HERE, error_model="numpy", forceinline=True)
unlocked = compiler(_HERE, error_model="numpy", nogil=True, forceinline=True)
"""The same for what threads run side by side."""
compiled_sum = compiler(_HERE, error_model="numpy", fastmath={"reassoc"})
"""For a loop that sums: its additions may be taken in another order, which is what several elements at once
takes. The order is fixed when the function is compiled, so that equal input gives equal bits; a processor
with other vector instructions may round otherwise. Functions that it calls keep their own order."""


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
        yield
    finally:
        timer.cancel()
