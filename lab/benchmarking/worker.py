"""Plays an environment in a separate process."""

from __future__ import annotations

from collections.abc import Callable
from multiprocessing import get_context
from typing import Any, Protocol

from lab.benchmarking.processors import pin


class Player(Protocol):
    """Plays something when asked to."""

    def block(self, steps: int) -> tuple[float, int]:
        """The time that some steps took [s], and how many they were."""
        ...


class Worker:
    """A player in a process of its own.

    Args:
        make: Makes a player, in the process that plays; it is pickled.
        *arguments: Its arguments.
        processor: Numbers of the processors that it keeps to; empty: all.
    """

    def __init__(
        self, make: Callable[..., Player], *arguments: Any, processor: set[int] | None = None
    ) -> None:
        context = get_context("spawn")
        self._end, there = context.Pipe()
        self._process = context.Process(
            target=_play, args=(there, processor or set(), make, arguments), daemon=True
        )
        self._process.start()
        there.close()

    @property
    def exitcode(self) -> int | None:
        """Exit code of the process; None while it runs."""
        return self._process.exitcode

    def wait(self) -> None:
        """Return when the player is made."""
        self._end.recv()

    def ask(self, steps: int) -> None:
        """Have it play some steps."""
        self._end.send(steps)

    def answer(self) -> tuple[float, int]:
        """The time that the steps asked for took [s], and how many they were."""
        return self._end.recv()

    def block(self, steps: int) -> tuple[float, int]:
        """`ask` and `answer`."""
        self.ask(steps)
        return self.answer()

    def close(self) -> None:
        """End the process."""
        self._end.send(0)
        self._process.join()


def _play(end: Any, processor: set[int], make: Callable[..., Player], arguments: tuple[Any, ...]) -> None:
    pin(processor)
    player = make(*arguments)
    end.send(True)
    while steps := end.recv():
        end.send(player.block(steps))
