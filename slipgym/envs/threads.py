"""Threads that share the rows of a batch."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from threading import Semaphore

LEAST = 32
"""Rows from which another thread is worth waking."""
MOST = 512
"""Rows of a part: who is done early takes another."""


class Threads:
    """Runs a function over parts of n rows; each thread takes the next part until none is left.

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
            threads = max(1, min(processors(), n // LEAST))
        elif isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
            raise ValueError(f"threads = {threads!r} must be None or a whole number >= 1")
        self.count = min(threads, n)
        parts = self.count if self.count == 1 else max(self.count, -(-n // MOST))
        self._parts = list(pairwise(n * k // parts for k in range(parts + 1)))
        self._pool: ThreadPoolExecutor | None = None
        self._process = -1

    def run(
        self, function: Callable[[int, int], int], meanwhile: Callable[[], None] | None = None
    ) -> list[int]:
        """What the function returns for each part (first row, row after the last).

        Args:
            function: What is done with a part.
            meanwhile: What this thread does first, while the others begin.
        """
        left, results = iter(enumerate(self._parts)), [0] * len(self._parts)
        begun = Semaphore(0)

        def work() -> None:
            for k, part in left:
                results[k] = function(*part)

        def begin() -> None:
            begun.release()
            work()

        others = [self._threads().submit(begin) for _ in range(self.count - 1)]
        try:
            if meanwhile is not None:
                for _ in others:  # the interpreter is theirs until they have begun
                    begun.acquire()
                meanwhile()
            work()
        finally:
            for other in others:
                other.result()
        return results

    def close(self) -> None:
        """End the threads."""
        if self._pool is not None and self._process == os.getpid():
            self._pool.shutdown()
        self._pool = None

    def _threads(self) -> ThreadPoolExecutor:
        if self._pool is None or self._process != os.getpid():
            self._pool, self._process = ThreadPoolExecutor(self.count - 1, "slipgym"), os.getpid()
        return self._pool


def processors() -> int:
    """How many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):  # not on macOS and Windows
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
