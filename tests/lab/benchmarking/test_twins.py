"""Two processes play alone and at once, each on its processor, and end."""

import os

from lab.benchmarking import processors
from lab.benchmarking.processors import on_either, two_processors
from lab.benchmarking.twins import Twins


class Sleeper:
    """Takes as long as it says, and longer from block to block."""

    def __init__(self, second):
        self.seconds = 0.0
        self.second = second

    def block(self, steps):
        self.seconds += self.second
        return self.seconds * steps, steps


def test_alone_and_both():
    with Twins(Sleeper, 0.5) as twins:
        assert twins.alone(4) == (1.0, 2.0)  # a step in half a second, on either
        assert twins.both(4) == (1.0, 2.0)  # a step in a second, on both
        assert all(worker.exitcode is None for worker in twins._workers)
    assert [worker.exitcode for worker in twins._workers] == [0, 0]


def allowed():
    """Processors that this thread may use; none where the system does not say."""
    return os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set()


class Allowed:
    """Says on how many processors it runs."""

    def block(self, steps):
        return 1.0, len(allowed())


def test_each_keeps_to_one_processor():
    before, pair = allowed(), two_processors()
    with Twins(Allowed) as twins:
        assert twins.both(1) == (1.0, len(pair[0]) + len(pair[1]))
    seen = []

    def block():
        seen.append(allowed())
        return 0.5, 1

    assert on_either(block) == (1.0, 2.0)
    assert seen == pair
    assert allowed() == before


def test_the_mean_is_that_of_speeds_and_not_of_times():
    times = iter([1.0, 0.25])
    assert on_either(lambda: (next(times), 1)) == (1.0, 2.5)


def test_systems_that_cannot_choose_run_all_the_same(monkeypatch):
    monkeypatch.delattr(processors.os, "sched_getaffinity", raising=False)
    assert on_either(lambda: (0.5, 3)) == (1.0, 6.0)
