"""Receives readings of two fingers, each sensor at its own rate, and gives an estimate for each velocity."""

from __future__ import annotations

import math
import reprlib
import time
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from estimator.live.hand import Hand, Output
from estimator.live.source import Source
from estimator.online import TWIST, WRENCH, OnlineEstimator, make
from estimator.records.units import TILT
from estimator.registry import DEFAULT
from estimator.suggestions import asking, brief

CLOCKS = ("stamps", "arrival")
KINDS = {"wrench": "force", "twist": "velocity"}
APART = 0.05
"""Difference of the clocks of a finger's sensors that is a warning [s]; networks delay by less."""


class Live:
    """The readings of a gripper, one at a time.

    A velocity sample is paired with the newest force at or before it, by the rule that records go by: the
    estimates are those of `estimator.records.estimate`, bit for bit. It waits until a reading of its finger
    is newer by `lateness`; what is older by then is refused and counted.

    Args:
        estimator: One of `estimator.names()`.
        fingers: 1 or 2.
        rates: Of force and velocity [Hz]; five periods without a sample are a gap, after which the estimator
            begins afresh.
        lateness: How much older than the newest reading of its finger one may be [s].
        clocks: "stamps": all sensors of a finger stamp by one clock. "arrival": each has its own; its stamps
            are moved to the receiver's clock by the smallest delay of the first 50.
        log: Takes each reading and each output as a mapping: a `Log`.
        **parameters: Of the estimator.

    Raises:
        ValueError: An argument is unknown or out of range.
    """

    def __init__(
        self,
        estimator: str = DEFAULT,
        fingers: int = 2,
        rates: tuple[float, float] = (1000.0, 120.0),
        lateness: float = 0.002,
        clocks: str = "stamps",
        log: Callable[[dict[str, Any]], None] | None = None,
        **parameters: Any,
    ) -> None:
        if fingers not in (1, 2):
            raise ValueError(f"fingers = {fingers!r}: expected 1 or 2")
        if clocks not in CLOCKS:
            raise ValueError(
                asking(f"clocks = {clocks!r}: expected one of {', '.join(CLOCKS)}", clocks, CLOCKS)
            )
        for name, rate in zip(("force", "velocity"), rates, strict=True):
            if not 1.0 <= rate <= 25e3:
                raise ValueError(f"rate of {name} = {rate!r} Hz: expected 1 to 25000")
        if not 0.0 <= lateness <= 1.0:
            raise ValueError(f"lateness = {lateness!r} s: expected 0 to 1")
        self.fingers, self.rates, self.grip = fingers, rates, math.nan
        self._log: Callable[[dict[str, Any]], None] = lambda line: None
        self._hands = {}
        for finger in range(1, fingers + 1):
            sources = {
                kind: Source(f"{what} {finger}", 1.0 / rate, clocks == "arrival")
                for (kind, what), rate in zip(KINDS.items(), rates, strict=True)
            }
            self._hands[finger] = Hand(finger, _ready(estimator, parameters), sources, lateness)
        self._arguments = {"live": 1, "estimator": estimator, "parameters": parameters, "rates": list(rates),
                           "lateness": lateness, "clocks": clocks}  # fmt: skip
        if log is not None:
            self.begin_log(log)

    def begin_log(self, log: Callable[[dict[str, Any]], None]) -> None:
        """Gives a log the arguments, and from now on each reading and each output."""
        self._log = log
        log(self._arguments)

    def feed_wrench(
        self, finger: int, stamp: float, wrench: Sequence[float], arrival: float | None = None
    ) -> list[Output]:
        """Takes a reading of a force/torque sensor.

        Args:
            finger: 1 or 2.
            stamp: When it was measured [s].
            wrench: f_x, f_y, f_n, tau at the CoP, or also tau_x, tau_y, all at the sensor's origin
                [N, N, N, N m]: of the pad on the object, as in records.
            arrival: When it was received, on a clock that never goes back [s]; None: now. Give the stamp
                itself to feed what was recorded.

        Returns:
            What can be estimated now, often nothing.

        Raises:
            ValueError: There is no such finger, or the reading is not 4 or 6 numbers.
        """
        return self._feed("wrench", finger, stamp, _numbers("wrench", wrench, WRENCH, TILT), arrival)

    def feed_twist(
        self, finger: int, stamp: float, twist: Sequence[float], arrival: float | None = None
    ) -> list[Output]:
        """Takes a reading of a slip-velocity sensor: v_x, v_y, omega [m/s, m/s, rad/s].

        Send each sample once, and neither filtered nor interpolated. See `feed_wrench`.
        """
        return self._feed("twist", finger, stamp, _numbers("twist", twist, TWIST), arrival)

    def feed_grip(self, stamp: float, force: float, arrival: float | None = None) -> None:
        """Takes the grip force that the gripper itself reports or is commanded [N]; it is recorded."""
        self.grip, stamp = _number("grip", force, "N"), _number("t", stamp, "s")
        self._log({"grip": _plain(self.grip), "t": _plain(stamp), "arrival": _now(arrival)})

    def _feed(
        self, kind: str, finger: int, stamp: float, values: list[float], arrival: float | None
    ) -> list[Output]:
        arrival = _now(arrival)
        hand = self._hands.get(finger) if type(finger) is int else None
        if hand is None:
            raise ValueError(f"finger = {shown(finger)}: expected one of {', '.join(map(str, self._hands))}")
        stamp = _number("t", stamp, "s")
        source, outputs = hand.sources[kind], []
        verdict, t = source.judge(stamp, arrival, values, hand.done)
        source.counts["received"] += 1
        source.counts["accepted" if verdict == "restart" else verdict] += 1
        if verdict == "restart":
            outputs = hand.restart()
            source.counts["restart"] += 1
        if verdict in ("accepted", "restart"):
            outputs = outputs + hand.take(source, t, values, arrival)
        else:
            hand.notes[verdict] += 1
        line = {"finger": finger, "t": _plain(stamp), kind: [_plain(value) for value in values]}
        self._log(
            {**line, "arrival": arrival, "verdict": verdict} | ({} if t == stamp else {"at": _plain(t)})
        )
        return self._logged(outputs)

    def flush(self) -> list[Output]:
        """Estimates from all that still waits: the data have ended."""
        return self._logged([output for hand in self._hands.values() for output in hand.release(math.inf)])

    def _logged(self, outputs: list[Output]) -> list[Output]:
        for output in outputs:
            self._log(as_line(output))
        return outputs

    @property
    def counts(self) -> dict[str, Counter[str]]:
        """Of each sensor, what became of its readings.

        `received` is the sum of `accepted` and all reasons to refuse: `late`, `duplicate`, `not_finite`,
        `too_large`, `jump` (a stamp on another clock), `clock` (used to find its offset), `width`,
        `overflow`.
        `accepted` velocities are `estimated`, have `no_force`, or are `waiting`; by the rate, `missing` never
        came.
        """
        return {source.name: source.counted() for source in self._sources()}

    def silent(self, now: float, longest: float) -> list[str]:
        """The sensors without an accepted reading in the last seconds [s]."""
        return [source.name for source in self._sources() if now - source.arrival > longest]

    def clocks(self) -> dict[str, float]:
        """Of each sensor, the receiver's clock less its own, with the smallest recent delay [s]."""
        return {source.name: source.offset for source in self._sources()}

    def warnings(self) -> dict[int, str]:
        """Of each finger whose sensors' clocks differ, or by arrival have drifted apart, by how much."""
        lines = {}
        for hand in self._hands.values():
            apart = hand.force.ahead - hand.velocity.ahead
            if abs(apart) > APART:
                lines[hand.finger] = (
                    f"the clock of {hand.velocity.name} is {apart:+.3f} s against that of {hand.force.name}: "
                    "set them alike, or use clocks='arrival'"
                )
        return lines

    def _sources(self) -> list[Source]:
        return [source for hand in self._hands.values() for source in hand.sources.values()]


def as_line(output: Output) -> dict[str, Any]:
    """An output as a flat mapping that JSON can hold."""
    given = {"finger": output.finger, "t": output.t, "status": output.status, "lag": output.lag}
    return {"estimate": 1, **given, **output.estimate._asdict()}


def _ready(name: str, parameters: dict[str, Any]) -> OnlineEstimator:
    """An estimator whose compiled code is loaded, which takes a second at its first sample."""
    found = make(name, **parameters)
    found.update(0.0, [0.0] * len(WRENCH), [0.0] * len(TWIST))
    found.reset()
    return found


def _now(arrival: float | None) -> float:
    return time.monotonic() if arrival is None else float(arrival)


def _plain(value: float) -> float | None:
    return value if math.isfinite(value) else None


def shown(value: Any) -> str:
    """A value of a message, whatever it is, for an error: shortened, and lists in lists to a few levels."""
    return brief(reprlib.repr(value))


def _float(value: Any) -> float:
    """A number, finite or not; null is a reading that failed."""
    if isinstance(value, str | bytes | bool):
        raise TypeError(f"{shown(value)} is no number")
    return math.nan if value is None else float(value)


def _number(key: str, value: Any, unit: str) -> float:
    try:
        return _float(value)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{key} = {shown(value)}: expected a number [{unit}]") from None


def _numbers(key: str, values: Any, names: Sequence[str], more: Sequence[str] = ()) -> list[float]:
    """Numbers of the names, or also of more."""
    try:
        numbers = [_float(value) for value in values]
    except (TypeError, ValueError, OverflowError):
        numbers = []
    if len(numbers) not in {len(names), len(names) + len(more)}:
        also = f", or {len(names) + len(more)}, with {', '.join(more)}" if more else ""
        wanted = f"{len(names)} numbers, {', '.join(names)}{also}"
        raise ValueError(f"{key} = {shown(values)}: expected {wanted}")
    return numbers
