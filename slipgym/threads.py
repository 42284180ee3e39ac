"""Runs a compiled function over the rows of a vector environment in several threads."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from itertools import islice, pairwise

LEAST = 32
"""Smallest number of rows per thread for which another thread is started."""
SMALL = 256
"""Rows of the smallest part: more and smaller parts would reduce the benefit of a second core."""


class Threads:
    """Runs a function over parts of n rows; each thread takes the next part until none is left.

    The function must release the interpreter's lock. Results do not depend on the number of threads. The
    threads are started at first use, in the process that uses them, so that a fork is harmless.

    Args:
        n: Number of rows.
        threads: Number of threads; None: one per processor that this process may use, with at least 32 rows
            each.

    Raises:
        ValueError: `threads` is not a whole number >= 1.
    """

    def __init__(self, n: int, threads: int | None) -> None:
        if threads is None:
            threads = max(1, min(processors(), n // LEAST))
        elif isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
            raise ValueError(f"threads = {threads!r} must be None or a whole number >= 1")
        self.count = min(threads, n)
        self._parts = list(pairwise(_ends(n, self.count)))
        self._pool: ThreadPoolExecutor | None = None
        self._process = -1

    def run(
        self, function: Callable[[int, int], int], meanwhile: Callable[[], None] | None = None
    ) -> list[int]:
        """Run a function on every part and return its results.

        Args:
            function: Function of a part's first row and the row after its last.
            meanwhile: Function that this thread calls after its first part, while the others work.
        """
        left, results = iter(enumerate(self._parts)), [0] * len(self._parts)

        def work(parts: Iterable[tuple[int, tuple[int, int]]]) -> None:
            for k, part in parts:
                results[k] = function(*part)

        others: list[Future[None]] = []
        try:
            for _ in range(self.count - 1):
                others.append(self._threads().submit(work, left))
            work(islice(left, 1))  # it needs no lock: the others get it, and begin
            if meanwhile is not None:
                meanwhile()
            work(left)
        finally:
            if others:
                _finish(others)
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


def _finish(others: list[Future[None]]) -> None:
    """Wait for all threads, whatever interrupts it: none may still write when the caller goes on."""
    interrupt: BaseException | None = None
    while True:
        try:
            wait(others)
            break
        except BaseException as error:
            interrupt = error
    if interrupt is not None:
        raise interrupt
    for other in others:
        other.result()


def _ends(n: int, threads: int) -> list[int]:
    """Bounds of the parts of n rows, from 0 to n: a smaller part, then large ones, then ever smaller ones.

    The first part occupies this thread while the others wake up. The large parts occupy the others while this
    thread holds the interpreter's lock. Small last parts let all threads finish at about the same time.
    """
    if threads == 1:
        return [0, n]
    small = min(SMALL, -(-n // threads))
    ends = [0, max(small, n // (4 * threads))]
    while ends[-1] < n:
        ends.append(min(n, ends[-1] + max(small, 4 * (n - ends[-1]) // (5 * threads))))
    return ends


def processors() -> int:
    """Number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):  # not on macOS and Windows
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
