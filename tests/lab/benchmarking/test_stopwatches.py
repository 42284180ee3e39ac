"""Clocks of the benchmark's parts."""

import pytest

from lab.benchmarking import stopwatches
from lab.benchmarking.stopwatches import Stopwatches, per_call


class Clock:
    """A clock that only `wait` moves, in place of the machine's."""

    def __init__(self, monkeypatch):
        self.now = 0.0
        monkeypatch.setattr(stopwatches, "perf_counter", lambda: self.now)

    def wait(self, seconds):
        self.now += seconds


class Sleeper:
    def __init__(self, clock):
        self.clock = clock

    def outer(self):
        self.clock.wait(0.01)
        self.inner()

    def inner(self):
        self.clock.wait(0.03)


def test_stopwatches_count_a_function_without_those_it_calls(monkeypatch):
    clock = Clock(monkeypatch)
    sleeper = Sleeper(clock)
    with Stopwatches() as watches:
        watches.watch("outer", sleeper, "outer")
        watches.watch("inner", sleeper, "inner")
        sleeper.outer()
        sleeper.outer()
    assert watches.spent["outer"] == pytest.approx(0.02)
    assert watches.spent["inner"] == pytest.approx(0.06)
    assert vars(sleeper) == {"clock": clock}


def test_per_call_divides_by_the_calls(monkeypatch):
    clock = Clock(monkeypatch)
    assert per_call(lambda: clock.wait(0.002), calls=3, repeats=3) == pytest.approx(0.002)
