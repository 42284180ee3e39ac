"""Answers a gripper's messages, whatever carried them, with estimates and commands."""

from __future__ import annotations

import json
import math
import time
from collections import Counter
from collections.abc import Mapping
from typing import Any

from estimator.live.hand import Output
from estimator.live.live import KINDS, Live, as_line, shown
from estimator.live.log import Log

LONGEST = 65536
"""Bytes of a message at most."""
_FORMS = (*({"finger", "t", kind} for kind in KINDS), {"t", "grip"}, {"columns"})
_NO_OBJECT = "not a JSON object"
_ERRORS = 10
"""Messages a second at most whose error is answered and recorded; all are counted."""


class Session:
    """One gripper's traffic.

    Args:
        live: The core.
        pilot: What commands the gripper, with the methods of `policies.live.PolicyPilot`; None: nothing does.
        log: Where errors and commands go, best that of the core; None: nowhere.

    Attributes:
        malformed: How many messages were refused by their form, by why.
    """

    def __init__(self, live: Live, pilot: Any = None, log: Log | None = None) -> None:
        self.live, self.pilot, self.malformed = live, pilot, Counter()
        self._log, self._second, self._errors = log, 0, 0
        self._looked, self._warnings = -math.inf, {}

    def begin_log(self, log: Log) -> None:
        """Writes errors, commands and what the core writes to a log from now on."""
        self._log = log
        self.live.begin_log(log)

    def take(self, text: bytes | str, now: float | None = None) -> list[dict[str, Any]]:
        """Answers one message.

        Args:
            text: A JSON object: `finger`, `t` and `wrench` or `twist`; `t` and `grip`; or `columns`.
            now: Its arrival, on a clock that never goes back [s]; None: now.
        """
        return self.give(_message(text), now)

    def give(self, message: Any, now: float | None = None) -> list[dict[str, Any]]:
        """Answers a message that is a mapping already."""
        now = time.monotonic() if now is None else now
        try:
            outputs = self._feed(message, now)
        except ValueError as error:
            return self._refuse(str(error)[:200], now)
        command = self.pilot.act(outputs, now) if self.pilot and outputs else None
        return [*map(as_line, outputs), *self._commanded(command)]

    def _feed(self, message: Any, now: float) -> list[Output]:
        if isinstance(message, str):
            raise ValueError(message)
        if not isinstance(message, Mapping):
            raise ValueError(_NO_OBJECT)
        keys = next((keys for keys in _FORMS if keys == set(message)), None)
        if keys is None:
            forms = "; ".join(", ".join(sorted(keys)) for keys in _FORMS)
            raise ValueError(f"keys {shown(list(message))}: expected those of one form: {forms}")
        if "columns" in keys:
            if self.pilot is None:
                raise ValueError("columns: expected where a policy runs alone (--policy)")
            if not isinstance(message["columns"], Mapping):
                raise ValueError(
                    f"columns = {shown(message['columns'])}: expected a mapping of names to numbers"
                )
            self.pilot.set_columns(message["columns"])
        elif "grip" in keys:
            self.live.feed_grip(message["t"], message["grip"], now)
        elif "wrench" in keys:
            return self.live.feed_wrench(message["finger"], message["t"], message["wrench"], now)
        else:
            return self.live.feed_twist(message["finger"], message["t"], message["twist"], now)
        return []

    def tick(self, now: float | None = None) -> list[dict[str, Any]]:
        """The commands that are due without a message, the watchdog's. Call it at least every 20 ms."""
        now = time.monotonic() if now is None else now
        command = self.pilot.watch(self.live, now) if self.pilot else None
        return [*self._warned(now), *self._commanded(command)]

    def _warned(self, now: float) -> list[dict[str, Any]]:
        """Once a second, the warnings that were not there a second ago."""
        if abs(now - self._looked) < 1.0:
            return []
        before, self._looked, self._warnings = self._warnings, now, self.live.warnings()
        lines = [{"warning": text} for finger, text in self._warnings.items() if finger not in before]
        for line in lines:
            self._record({**line, "arrival": now})
        return lines

    def _commanded(self, command: dict[str, Any] | None) -> list[dict[str, Any]]:
        if command is None:
            return []
        self._record(command)
        return [command]

    def _refuse(self, why: str, now: float) -> list[dict[str, Any]]:
        self.malformed[why if len(self.malformed) < 100 or why in self.malformed else "others"] += 1
        if int(now) != self._second:
            self._second, self._errors = int(now), 0
        self._errors += 1
        if self._errors > _ERRORS:
            return []
        self._record({"error": why, "arrival": now})
        return [{"error": why}]

    def _record(self, line: dict[str, Any]) -> None:
        if self._log:
            self._log(line)

    def report(self) -> str:
        """Counts of all readings by their fate, in lines."""
        lines = []
        for name, counts in self.live.counts.items():
            found = ", ".join(f"{what} {often}" for what, often in counts.items() if often)
            lines.append(f"{name}: {found or 'received nothing'}")
        lines += [f"{often} messages refused: {why}" for why, often in self.malformed.most_common(5)]
        if self._log and self._log.lost:
            lines.append(f"Warning: {self._log.lost} lines are not in {self._log.path}: {self._log.why}")
        return "\n".join([*lines, *(f"Warning: {line}" for line in self.live.warnings().values())])


def _message(text: bytes | str) -> dict[str, Any] | str:
    """The object, or what is wrong with the text."""
    if len(text) > LONGEST:
        return f"longer than {LONGEST} bytes"
    try:
        message = json.loads(text)
    except (ValueError, RecursionError):
        return "not JSON"
    return message if isinstance(message, dict) else _NO_OBJECT
