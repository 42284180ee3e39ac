"""Judges the samples of one sensor one by one, keeps those that wait, and counts all of them."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections import Counter
from collections.abc import Sequence

from estimator.sample import LARGEST

JUMP = 1.0
"""Step of a stamp, against the last one and against its arrival, that no sensor makes [s]."""
RESTART = 20
"""Samples in a row on another clock from which the sensor's clock was set anew."""
LEARNED = 50
"""Samples from which the offset of a clock against that of the receiver is taken."""
CAPACITY = 4096
"""Samples that wait at most; more within the lateness are no sensor's."""
_CAME = ("accepted", "not_finite", "too_large", "width", "late", "overflow")
"""What became of samples that a sensor took at its rate."""
_BUCKET = 5.0  # [s]
_EMPTY = -math.inf, math.inf, math.inf  # of the buckets: begin, smallest in it, smallest in the one before


class Source:
    """One stream of one finger.

    Args:
        name: "force 1", for messages.
        period: Usual time between two samples [s].
        by_arrival: Whether stamps are moved to the clock of the receiver.

    Attributes:
        t: Stamps that wait, increasing [s].
        rows: Their readings.
        counts: What became of the samples.
        offset: Smallest arrival less stamp of the last seconds [s]; NaN before the first sample.
        arrival: When the last sample was accepted [s]; -inf: never.
    """

    def __init__(self, name: str, period: float, by_arrival: bool) -> None:
        self.name, self.period = name, period
        self.t: list[float] = []
        self.rows: list[list[float]] = []
        self.counts: Counter[str] = Counter()
        self.offset, self.arrival = math.nan, -math.inf
        self._stamp = self._candidate = math.nan
        self._width, self._spans, self._first, self._last = 0, 0, math.inf, -math.inf
        self._others, self._learned = 0, 0 if by_arrival else LEARNED
        self._by_arrival, self._shift = by_arrival, math.inf if by_arrival else 0.0
        self._buckets = _EMPTY

    def judge(self, stamp: float, arrival: float, values: Sequence[float], done: float) -> tuple[str, float]:
        """Decides on a sample by its sensor's stamp and its arrival; before `done` none is taken [s].

        Returns:
            "accepted", "restart" (accepted, on a clock set anew), or why it is refused; and its time [s].
        """
        if not (math.isfinite(stamp) and all(map(math.isfinite, values))):
            return "not_finite", stamp
        if max(map(abs, values)) >= LARGEST:
            return "too_large", stamp
        self._width = self._width or len(values)
        if len(values) != self._width:
            return "width", stamp
        restart = False
        if abs(stamp - self._stamp) > JUMP and abs(arrival - stamp - self.offset) > JUMP:
            same = abs(arrival - stamp - self._candidate) <= JUMP
            self._others, self._candidate = self._others * same + 1, arrival - stamp
            if self._others < RESTART:
                return "jump", stamp
            restart, self._buckets = True, _EMPTY
            if self._by_arrival:
                self._learned, self._shift = 0, math.inf
        self._others, self._stamp = 0, stamp
        self._measure(arrival, arrival - stamp)
        if self._learned < LEARNED:
            self._learned, self._shift = self._learned + 1, min(self._shift, arrival - stamp)
            return "clock", stamp
        if restart:
            return "restart", stamp
        return self._place(stamp + self._shift, done)

    def _place(self, t: float, done: float) -> tuple[str, float]:
        if t < done:
            return "late", t
        k = bisect_left(self.t, t)
        if k < len(self.t) and self.t[k] == t:
            return "duplicate", t
        return ("overflow" if len(self.t) >= CAPACITY else "accepted"), t

    def _measure(self, arrival: float, offset: float) -> None:
        begin, smallest, before = self._buckets
        if arrival - begin > _BUCKET:
            begin, smallest, before = arrival, math.inf, smallest
        self._buckets = begin, min(smallest, offset), before
        self.offset = min(self._buckets[1:])

    @property
    def ahead(self) -> float:
        """Offset minus the correction of the stamps [s]."""
        return self.offset - (self._shift if math.isfinite(self._shift) else self.offset)

    def insert(self, t: float, values: list[float], arrival: float) -> None:
        """Lets an accepted sample wait."""
        k = bisect_left(self.t, t)
        self.t.insert(k, t)
        self.rows.insert(k, values)
        self.arrival = arrival
        self._first, self._last = min(self._first, t), max(self._last, t)

    def drop(self, n: int) -> None:
        """Forgets the first n samples that wait."""
        del self.t[:n], self.rows[:n]

    def restart(self) -> None:
        """Begins another span of time."""
        self._spans, self._first, self._last = self._spans + self._expected(), math.inf, -math.inf

    def _expected(self) -> int:
        """Samples that a sensor at its rate gives from the first accepted one to the last."""
        return round((self._last - self._first) / self.period) + 1 if self._first <= self._last else 0

    def counted(self) -> Counter[str]:
        """`counts`, with those that wait and those that never came."""
        came = sum(self.counts[what] for what in _CAME)
        missing = max(0, self._spans + self._expected() - came)
        return self.counts + Counter({"waiting": len(self.t), "missing": missing})
