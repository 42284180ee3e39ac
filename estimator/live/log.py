"""Writes what passes to a file of JSON lines, and reads it back: as records, or to convert it to MCAP."""

from __future__ import annotations

import errno
import importlib
import json
import os
from array import array
from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from estimator.records.reading import CONTACT
from estimator.records.record import Array, Record, cop_of_tilt, wrench_at

fcntl: Any
try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

_Part: TypeAlias = dict[str, tuple["array[float]", "array[float]"]]
"""Of "wrench" and "twist" the times and all values."""
_LISTS = {"wrench": ["f_x", "f_y", "f_n", "tau", "tau_x", "tau_y"], "twist": ["v_x", "v_y", "omega"]}
_TYPES = {bool: "boolean", int: "integer", str: "string", list: "array", dict: "object"}


class Log:
    """A file that only grows, one JSON object a line; a kill costs at most the line being written.

    Until it is closed no other log writes to the file, where files can be locked (not on Windows).

    Args:
        path: The file; if it exists, it is continued, without the rest of a broken last line.

    Attributes:
        path: As given.
        lost: Lines that could not be written: the disk is full, for example.
        why: What the operating system said of the last of them.

    Raises:
        ValueError: There is a file that is no such log, or another log writes to it.
        OSError: It cannot be opened.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path, self.lost, self.why = Path(path), 0, ""
        if self.path.exists() and not self.path.is_file():
            raise ValueError(f"{path} is not a regular file")
        if self.path.exists() and self.path.stat().st_size:
            next(read(self.path))
        self._file = self.path.open("ab+", buffering=0)
        try:
            _lock(self._file, self.path)
            self._size = _whole(self._file)
            self._file.truncate(self._size)
        except BaseException:
            self._file.close()
            raise

    def __call__(self, line: dict[str, Any]) -> None:
        """Appends a line; it is with the operating system when this returns. A full disk stops no gripper."""
        text = json.dumps(line, separators=(",", ":"), allow_nan=False).encode() + b"\n"
        try:
            written = self._file.write(text)
            if written != len(text):
                self._file.truncate(self._size)
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            self._size += written
        except OSError as error:
            self.lost, self.why = self.lost + 1, str(error)

    def close(self) -> None:
        """Closes the file."""
        self._file.close()


def _lock(file: Any, path: Path) -> None:
    """Locks an open file; closing it, or the end of the process, unlocks it."""
    if fcntl is None:
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise ValueError(f"{path}: another session writes this log; name another file, or end it") from None
    except OSError:  # a file system without locks
        pass


def _whole(file: Any) -> int:
    """Length of a file up to its last end of line."""
    at = file.seek(0, os.SEEK_END)
    while at > 0:
        begin = max(0, at - 65536)
        file.seek(begin)
        if (found := file.read(at - begin).rfind(b"\n")) >= 0:
            return begin + found + 1
        at = begin
    return 0


def read(path: str | os.PathLike[str]) -> Iterator[dict[str, Any]]:
    """Reads the lines of a log; a last line that is broken off is left out.

    Raises:
        ValueError: The file is no log, or a line is damaged.
        OSError: It cannot be opened.
    """
    with open(path, encoding="utf-8", errors="replace") as file:
        for number, text in enumerate(file, 1):
            try:
                line = json.loads(text)
            except ValueError:
                line = None
            if not text.endswith("\n") and number > 1:
                return
            if not isinstance(line, dict) or (number == 1 and "live" not in line):
                raise ValueError(f"{path}: line {number} is not one of a log of slipgym live")
            yield line


def records(path: str | os.PathLike[str]) -> dict[int, list[Record]]:
    """The readings that a log has accepted, as records for `estimator.records.estimate`.

    Args:
        path: The log.

    Returns:
        Of each finger its records: one, and a further one after each start of the program and of a clock.

    Raises:
        ValueError: The file is no log.
    """
    parts: dict[int, list[_Part]] = {}
    periods = (1e-3, 1.0 / 120.0)
    for line in read(path):
        if "rates" in line:
            periods = (1.0 / line["rates"][0], 1.0 / line["rates"][1])
            for of_finger in parts.values():
                of_finger.append({})
        if line.get("verdict") not in ("accepted", "restart"):
            continue
        of_finger = parts.setdefault(line["finger"], [{}])
        if line["verdict"] == "restart":
            of_finger.append({})
        kind = "wrench" if "wrench" in line else "twist"
        t, values = of_finger[-1].setdefault(kind, (array("d"), array("d")))
        t.append(line.get("at", line["t"]))
        values.extend(line[kind])
    name = Path(path).name
    return {
        finger: [_record(name, part, periods) for part in found if len(part) == 2]
        for finger, found in parts.items()
    }


def _record(name: str, part: _Part, periods: tuple[float, float]) -> Record:
    (force_t, wrench), (twist_t, twist) = (_ordered(*part[kind]) for kind in ("wrench", "twist"))
    cop = None
    if wrench.shape[1] == 6:
        cop = cop_of_tilt(wrench[:, 4:], wrench[:, 2], CONTACT)
        wrench = wrench_at(wrench[:, :4], cop)
    return Record(name, force_t, wrench, cop, twist_t, twist, None, None, periods)


def _ordered(t: array[float], values: array[float]) -> tuple[Array, Array]:
    order = np.argsort(t)
    return np.array(t)[order], np.array(values).reshape(len(t), -1)[order]


def to_mcap(log: str | os.PathLike[str], target: str | os.PathLike[str]) -> int:
    """Writes every line of a log as a JSON message, at the time of its arrival; returns how many there are.

    Raises:
        ModuleNotFoundError: mcap is not installed.
        ValueError: The log is none.
        OSError: A file cannot be read or written.
    """
    try:
        writer = importlib.import_module("mcap.writer")
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            "mcap is not installed: pip install 'slipgym[live]'", name="mcap"
        ) from error
    channels, part, arrival, n = {}, f"{os.fspath(target)}.part", 0.0, 0
    try:
        with open(part, "wb") as file:
            out = writer.Writer(file)
            out.start(profile="", library="slipgym")
            for line in read(log):
                n += 1
                arrival = line.get("arrival", arrival)
                topic, content = _named(line)
                if topic not in channels:
                    channels[topic] = _channel(out, topic, content)
                stamp = round(arrival * 1e9)
                out.add_message(channels[topic], stamp, json.dumps(content).encode(), stamp)
            out.finish()
        os.replace(part, target)
    except BaseException:
        if os.path.exists(part):
            os.remove(part)
        raise
    return n


def _named(line: dict[str, Any]) -> tuple[str, dict[str, Any]]:
    """Topic and content, with a name for each number."""
    for kind, names in _LISTS.items():
        if kind in line:
            values = dict(zip(names, line[kind], strict=False))
            rest = {key: value for key, value in line.items() if key != kind}
            return f"/finger_{line['finger']}/{kind}", {**rest, **values}
    if "estimate" in line:
        return f"/finger_{line['finger']}/estimate", line
    return "/" + next(name for name in ("live", "grip", "command", "error", *line) if name in line), line


def _channel(out: Any, topic: str, content: dict[str, Any]) -> int:
    types = {key: {"type": _TYPES.get(type(value), ["number", "null"])} for key, value in content.items()}
    schema = json.dumps({"type": "object", "properties": types}).encode()
    number = out.register_schema(f"slipgym{topic.replace('/', '.')}", "jsonschema", schema)
    return out.register_channel(topic, "json", number)
