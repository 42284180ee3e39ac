"""What a second core is worth to two processes that share nothing: the reference for two threads."""

from __future__ import annotations

from collections.abc import Callable
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any, Protocol

from slipgym.benchmarking.processors import SECOND, pin, two_processors


class Player(Protocol):
    """Plays something when asked to."""

    def block(self, steps: int) -> tuple[float, int]:
        """The time that some steps took [s], and how many they were."""
        ...


class Twins:
    """Two processes with a player each, alone or at the same time; as a context manager it ends them.

    Each keeps to a processor of its own: these differ in speed, at times.

    Args:
        make: Makes a player, in the process that plays; it is pickled.
        *arguments: Its arguments.
    """

    def __init__(self, make: Callable[..., Player], *arguments: Any) -> None:
        context = get_context("spawn")
        self._ends: list[Connection] = []
        self._processes = []
        for processor in two_processors():
            here, there = context.Pipe()
            process = context.Process(target=_play, args=(there, processor, make, arguments), daemon=True)
            process.start()
            self._ends.append(here)
            self._processes.append(process)
        for end in self._ends:
            end.recv()  # made

    def alone(self, steps: int) -> tuple[float, float]:
        """What one does in a second while the other rests: the mean of both, from a block of each in turn."""
        speeds = [self._speeds([end], steps)[0] for end in self._ends]
        return SECOND, sum(speeds) / len(speeds)

    def both(self, steps: int) -> tuple[float, float]:
        """What both together do in a second, from a block of both at once; at its end the slower is alone."""
        return SECOND, sum(self._speeds(self._ends, steps))

    def __enter__(self) -> Twins:
        return self

    def __exit__(self, *_: object) -> None:
        for end, process in zip(self._ends, self._processes, strict=True):
            end.send(0)
            process.join()

    @staticmethod
    def _speeds(ends: list[Connection], steps: int) -> list[float]:
        for end in ends:
            end.send(steps)
        results = [end.recv() for end in ends]
        return [made / seconds for seconds, made in results]


def _play(
    end: Connection, processor: set[int], make: Callable[..., Player], arguments: tuple[Any, ...]
) -> None:
    pin(processor)
    player = make(*arguments)
    end.send(True)
    while steps := end.recv():
        end.send(player.block(steps))
