"""Threads that share the rows of a batch."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

LEAST = 32
"""Rows from which another thread is worth waking."""


class Threads:
    """Runs a function over parts of n rows, one part per thread.

    The function must release the interpreter's lock. Results do not depend on the number of threads. The
    threads are started at first use, in the process that uses them, so that a fork is harmless.

    Args:
        n: Rows.
        threads: Threads; None: one per processor that this process may use, if there are rows for it.

    Raises:
        ValueError: `threads` is not a whole number >= 1.
    """

    def __init__(self, n: int, threads: int | None) -> None:
        if threads is None:
            threads = max(1, min(len(os.sched_getaffinity(0)), n // LEAST))
        elif isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
            raise ValueError(f"threads = {threads!r} must be None or a whole number >= 1")
        self.count = min(threads, n)
        ends = [n * k // self.count for k in range(self.count + 1)]
        self._parts = list(pairwise(ends))
        self._pool: ThreadPoolExecutor | None = None
        self._process = -1

    def run(self, function: Callable[[int, int], int]) -> list[int]:
        """What the function returns for each part (first row, row after the last)."""
        if self.count == 1:
            return [function(*self._parts[0])]
        if self._pool is None or self._process != os.getpid():
            self._pool, self._process = ThreadPoolExecutor(self.count - 1, "slipgym"), os.getpid()
        others = [self._pool.submit(function, *part) for part in self._parts[1:]]
        first = function(*self._parts[0])
        return [first, *(other.result() for other in others)]

    def close(self) -> None:
        """End the threads."""
        if self._pool is not None and self._process == os.getpid():
            self._pool.shutdown()
        self._pool = None
