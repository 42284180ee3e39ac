"""Measures the speed-up of two independent processes on two cores, as the reference for two threads."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from lab.benchmarking.processors import SECOND, two_processors
from lab.benchmarking.worker import Player, Worker


class Twins:
    """Two processes with a player each, alone or at the same time; as a context manager it ends them.

    Each keeps to a processor of its own: these differ in speed, at times.

    Args:
        make: Makes a player, in the process that plays; it is pickled.
        *arguments: Its arguments.
    """

    def __init__(self, make: Callable[..., Player], *arguments: Any) -> None:
        self._workers = [Worker(make, *arguments, processor=processor) for processor in two_processors()]
        for worker in self._workers:
            worker.wait()

    def alone(self, steps: int) -> tuple[float, float]:
        """What one does in a second while the other rests: the mean of both, from a block of each in turn."""
        speeds = [self._speeds([worker], steps)[0] for worker in self._workers]
        return SECOND, sum(speeds) / len(speeds)

    def both(self, steps: int) -> tuple[float, float]:
        """What both together do in a second, from a block of both at once; at its end the slower is alone."""
        return SECOND, sum(self._speeds(self._workers, steps))

    def __enter__(self) -> Twins:
        return self

    def __exit__(self, *_: object) -> None:
        for worker in self._workers:
            worker.close()

    @staticmethod
    def _speeds(workers: list[Worker], steps: int) -> list[float]:
        for worker in workers:
            worker.ask(steps)
        results = [worker.answer() for worker in workers]
        return [made / seconds for seconds, made in results]
