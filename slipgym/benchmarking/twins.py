"""What a second core is worth to two processes that share nothing: the reference for two threads."""

from __future__ import annotations

from collections.abc import Callable
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any, Protocol


class Player(Protocol):
    """Plays something when asked to."""

    def block(self, steps: int) -> tuple[float, int]:
        """The time that some steps took [s], and how many they were."""
        ...


class Twins:
    """Two processes with a player each, alone or at the same time; as a context manager it ends them.

    Args:
        make: Makes a player, in the process that plays; it is pickled.
        *arguments: Its arguments.
    """

    def __init__(self, make: Callable[..., Player], *arguments: Any) -> None:
        context = get_context("spawn")
        self._ends: list[Connection] = []
        self._processes = []
        for _ in range(2):
            here, there = context.Pipe()
            process = context.Process(target=_play, args=(there, make, arguments), daemon=True)
            process.start()
            self._ends.append(here)
            self._processes.append(process)
        for end in self._ends:
            end.recv()  # made

    def alone(self, steps: int) -> tuple[float, int]:
        """A block of one player while the other rests: its time [s] and steps."""
        return self._run(self._ends[:1], steps)

    def both(self, steps: int) -> tuple[float, int]:
        """A block of both at once: the longer time [s] and the steps of both."""
        return self._run(self._ends, steps)

    def __enter__(self) -> Twins:
        return self

    def __exit__(self, *_: object) -> None:
        for end, process in zip(self._ends, self._processes, strict=True):
            end.send(0)
            process.join()

    @staticmethod
    def _run(ends: list[Connection], steps: int) -> tuple[float, int]:
        for end in ends:
            end.send(steps)
        results = [end.recv() for end in ends]
        return max(seconds for seconds, _ in results), sum(made for _, made in results)


def _play(end: Connection, make: Callable[..., Player], arguments: tuple[Any, ...]) -> None:
    player = make(*arguments)
    end.send(True)
    while steps := end.recv():
        end.send(player.block(steps))
