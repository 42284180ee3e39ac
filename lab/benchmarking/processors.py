"""Measures the speed of one thread on processors whose speeds differ and change with other work."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

from lab.benchmarking.timing import Block

SECOND = 1.0
"""Time for which speeds are given as what is done in it."""


def two_processors() -> list[set[int]]:
    """The first two processors that this process may use; twice all of them if there is no choice.

    Whether they are of one core is not looked at.
    """
    if not hasattr(os, "sched_getaffinity"):  # not on macOS and Windows
        return [set(), set()]
    allowed = sorted(os.sched_getaffinity(0))
    return [{number} for number in allowed[:2]] if len(allowed) > 1 else [set(allowed)] * 2


def pin(processors: set[int]) -> None:
    """Keep this thread to some processors, if the system can and there are any."""
    if processors:
        os.sched_setaffinity(0, processors)


@contextmanager
def pinned(processors: set[int]) -> Iterator[None]:
    """Keep this thread to some processors for a while."""
    before = os.sched_getaffinity(0) if processors else set()
    pin(processors)
    try:
        yield
    finally:
        pin(before)


def on_either(block: Block) -> tuple[float, float]:
    """What a thread does in a second at the mean speed of two processors, from a block on each in turn."""
    speeds = []
    for processor in two_processors():
        with pinned(processor):
            seconds, steps = block()
        speeds.append(steps / seconds)
    return SECOND, sum(speeds) / len(speeds)
