"""Turns the waiting samples of one finger into estimates, in the order of their times."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections import Counter
from typing import NamedTuple

import numpy as np

from estimator.estimate import Estimate
from estimator.live.source import Source
from estimator.online import OnlineEstimator
from estimator.records.alignment import Limits, pair
from estimator.records.reading import CONTACT
from estimator.records.record import cop_of_tilt, twist_at, wrench_at


class Output(NamedTuple):
    """An estimate, and what it rests on."""

    finger: int
    """1 or 2."""
    t: float
    """Time of the velocity sample [s]."""
    wrench: list[float]
    """Newest f_x, f_y, f_n, tau at the CoP [N, N, N, N m]."""
    twist: list[float]
    """v_x, v_y, omega at the CoP [m/s, m/s, rad/s]."""
    estimate: Estimate
    """With the deviations of its values."""
    status: str
    """"ok", or what went wrong since the finger's last output: "gap 1, late 3"; "gap": the estimator began
    afresh."""
    lag: float
    """How much newer the newest reading of the finger is [s]."""


class Hand:
    """One finger.

    Args:
        finger: 1 or 2.
        estimator: Its own.
        sources: Of force and velocity.
        lateness: How much older than the newest reading one may be [s].
    """

    def __init__(
        self, finger: int, estimator: OnlineEstimator, sources: dict[str, Source], lateness: float
    ) -> None:
        self.finger, self.estimator, self.sources = finger, estimator, sources
        self.force, self.velocity, self._lateness = *sources.values(), lateness
        self._limits = Limits.of(self.force.period, self.velocity.period)
        self.newest, self.done = -math.inf, -math.inf
        self.notes: Counter[str] = Counter()
        self._last: tuple[float, int] | None = None  # time of the last sample, gaps before its force
        self._gaps = 0  # in the forces, before the first that waits

    def take(self, source: Source, t: float, values: list[float], arrival: float) -> list[Output]:
        """Lets an accepted sample wait, and estimates from all that need wait no longer."""
        source.insert(t, values, arrival)
        self.newest = max(self.newest, t)
        return self.release(self.newest - self._lateness)

    def restart(self) -> list[Output]:
        """Estimates from all that waits, and begins afresh on another clock."""
        outputs = self.release(math.inf)
        self.force.drop(len(self.force.t))
        self.newest = self.done = -math.inf
        self._last, self._gaps = None, 0
        for source in self.sources.values():
            source.restart()
        self.estimator.reset()
        self.notes["restart"] += 1
        return outputs

    def release(self, done: float) -> list[Output]:
        """Estimates from the velocities before a time [s]; nothing older is taken from then on."""
        self.done = max(self.done, done)
        n, outputs = bisect_left(self.velocity.t, self.done), []
        if n:
            outputs = self._estimate(n)
            self.velocity.drop(n)
        force = self.force
        old = max(bisect_left(force.t, self.done) - 1, 0)
        for k in range(old):
            self._gaps += force.t[k + 1] - force.t[k] > self._limits.force
        if old:
            force.drop(old)
        return outputs

    def _estimate(self, n: int) -> list[Output]:
        velocity, outputs = self.velocity, []
        t = np.array(velocity.t[:n])
        if not self.force.t:
            return self._unpaired(n)
        last = None if self._last is None else (self._last[0], self._last[1] - self._gaps)
        pairs = pair(np.array(self.force.t), t, self._limits, last)
        self._unpaired(n - len(pairs.kept))
        for place, at, fresh in zip(
            pairs.kept.tolist(), pairs.at.tolist(), pairs.fresh.tolist(), strict=True
        ):
            if fresh:
                self.estimator.reset()
                self.notes["gap"] += 1
            wrench, twist = at_cop(self.force.rows[at], velocity.rows[place])
            found = self.estimator.update(velocity.t[place], wrench, twist)
            status = ", ".join(f"{what} {often}" for what, often in sorted(self.notes.items())) or "ok"
            self.notes.clear()
            lag = self.newest - velocity.t[place]
            outputs.append(Output(self.finger, velocity.t[place], wrench, twist, found, status, lag))
            self._last = velocity.t[place], self._gaps + int(pairs.gaps[at])
        velocity.counts["estimated"] += len(outputs)
        return outputs

    def _unpaired(self, n: int) -> list[Output]:
        if n:
            self.velocity.counts["no_force"] += n
            self.notes["no_force"] += n
        return []


def at_cop(wrench: list[float], twist: list[float]) -> tuple[list[float], list[float]]:
    """Moves readings to the centre of pressure where tilting torques tell it, as records do.

    Args:
        wrench: f_x, f_y, f_n, tau, and perhaps tau_x, tau_y [N, N m].
        twist: v_x, v_y, omega [m/s, rad/s].
    """
    if len(wrench) == 4:
        return wrench, twist
    row = np.array([wrench])
    cop = cop_of_tilt(row[:, 4:], row[:, 2], CONTACT)
    return wrench_at(row[:, :4], cop)[0].tolist(), twist_at(np.array([twist]), cop)[0].tolist()
