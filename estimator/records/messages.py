"""Decodes messages of ROS 1 and ROS 2 by the definitions that a bag has; nothing is generated or executed.

Messages of sensors have the same layout each time, so that the places of all numbers are found in the first
one, and thousands of messages are then decoded at once.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from estimator.records.record import Array
from estimator.records.sources import LARGEST
from estimator.suggestions import brief

_CODES = {"bool": "u1", "byte": "u1", "char": "u1", "octet": "u1", "float32": "f4", "float64": "f8"} | {
    f"{sign}int{8 * size}": f"{sign or 'i'}{size}" for sign in ("", "u") for size in (1, 2, 4, 8)
}
_TIMES = ("time", "duration", "builtin_interfaces/Time", "builtin_interfaces/Duration")
_FIELD = re.compile(r"([A-Za-z][\w/]*)(?:<=\d+)?(\[(<?=?)(\d*)\])?\s+([A-Za-z]\w*)\s*(=?)")
_DEPTH, _MOST = 16, 16 * LARGEST  # nesting and values of a message

Field = tuple[str, int | None, str]
"""Type; None: one value, -1: a sequence, or the length of an array; name."""
Definitions = Mapping[str, list[Field]]


def definitions(text: str, name: str) -> Definitions:
    """The fields of a type of messages, as geometry_msgs/msg/Wrench, and of those in it.

    In the text other definitions follow below lines of = and `MSG: package/Type`.
    """
    found: dict[str, list[Field]] = {}
    name = name.replace("/msg/", "/")
    for line in text.splitlines():
        line = line.partition("#")[0].strip()
        if line.startswith("MSG:"):
            name = line[4:].strip().replace("/msg/", "/")
        fields = found.setdefault(name, [])
        if (match := _FIELD.match(line)) and not match[6]:
            count = None if not match[2] else int(match[4]) if match[4] and not match[3] else -1
            fields.append((match[1].replace("/msg/", "/"), count, match[5]))
    return found


class Layout:
    """Places of the numbers in a message, found by going through one in the order of its bytes.

    Args:
        defined: Definitions of its type and of those in it.
        kind: Its type.
        cdr: Whether it is of ROS 2.
        raw: Its bytes.

    Raises:
        ValueError: The definition does not fit, or is not one of these encodings.
    """

    def __init__(self, defined: Definitions, kind: str, cdr: bool, raw: bytes) -> None:
        if cdr and (len(raw) < 4 or raw[0] or raw[1] > 1):
            raise ValueError(f"the encoding {brief(raw[:4].hex())} of a message is not plain CDR")
        self._defined, self._raw, self._cdr = defined, raw, cdr
        self._values, self._at = 0, 4 if cdr else 0
        self._order = ">" if cdr and raw[1] == 0 else "<"
        self._places: dict[str, tuple[str, int]] = {}
        """Path of a field -> its type and its first byte; the type "t" is a time."""
        self.keys: list[int] = []
        """Bytes that messages of the same layout have in common: lengths, and names of joints."""
        self._one(kind.replace("/msg/", "/"), "")

    def decode(self, block: Any, wanted: Callable[[str], bool]) -> dict[str, Any]:
        """Columns, each (n,), of messages of this layout, whose bytes are (n, length)."""

        def column(code: str, at: int) -> Array:
            dtype = np.dtype(self._order + code)
            cells = np.ascontiguousarray(block[:, at : at + dtype.itemsize]).view(dtype)[:, 0]
            return cells.astype(dtype.newbyteorder("="))

        found = {}
        for path, (code, at) in self._places.items():
            if wanted(path) and code == "t":
                found[path] = (column("i4", at) * np.int64(10**9) + column("u4", at + 4)) / 1e9
            elif wanted(path):
                found[path] = column(code, at)
        return found

    def _take(self, size: int, align: int) -> int:
        """The place of the next bytes."""
        if self._cdr:
            self._at += -(self._at - 4) % align
        at, self._at = self._at, self._at + size
        if self._at > len(self._raw):
            raise ValueError("a message is shorter than its definition says")
        return at

    def _count(self) -> int:
        at = self._take(4, 4)
        self.keys += range(at, at + 4)
        return int.from_bytes(self._raw[at : at + 4], "little" if self._order == "<" else "big")

    def _text(self, key: bool) -> str:
        n = self._count()
        at = self._take(n, 1)
        if key:
            self.keys += range(at, at + n)
        return self._raw[at : at + n].rstrip(b"\0").decode("utf-8", "replace")

    def _one(self, kind: str, path: str, depth: int = 0) -> None:
        """A value of any type but a text."""
        places, self._values = self._places, self._values + 1
        if self._values > _MOST:
            raise ValueError(f"{brief(path)}: a message has more than {_MOST} values")
        if kind in _TIMES:
            places[path] = ("t", self._take(8, 4))
        elif kind in _CODES:
            size = int(_CODES[kind][1])
            places[path] = (_CODES[kind], self._take(size, size))
        elif kind == "string":
            self._text(False)
        elif depth > _DEPTH:
            raise ValueError(f"{brief(path)}: is nested more than {_DEPTH} deep")
        else:
            self._struct(kind, path, depth)

    def _struct(self, kind: str, path: str, depth: int) -> None:
        fields, names = self._fields(kind, path), []
        if not fields and self._cdr:
            self._take(1, 1)
        for inner, count, name in fields:
            below = f"{path}.{name}" if path else name
            if count is None:
                self._one(_absolute(inner, kind), below, depth + 1)
                continue
            n = self._count() if count < 0 else count
            if inner == "string":
                if n > LARGEST:
                    raise ValueError(f"{brief(below)}: {n} texts, more than {LARGEST}")
                texts = [self._text(True) for _ in range(n)]
                names = texts if name == "name" else names
            elif inner in _CODES and n > LARGEST:  # a picture
                size = int(_CODES[inner][1])
                self._take(size * n, size)
            elif n > LARGEST:
                raise ValueError(f"{brief(below)}: {n} values, more than {LARGEST}")
            else:
                named = len(names) == n == len(set(names))
                for k in range(n):
                    each = f"{below}[{names[k] if named else k}]"
                    self._one(_absolute(inner, kind), each, depth + 1)

    def _fields(self, kind: str, path: str) -> list[Field]:
        if kind in self._defined:
            return self._defined[kind]
        if (found := [name for name in self._defined if name.endswith("/" + kind.rpartition("/")[2])]) != []:
            return self._defined[found[0]]
        raise ValueError(f"{brief(path)}: its type {brief(kind)} is not defined")


def _absolute(kind: str, within: str) -> str:
    """The full name of a type that a definition names without its package."""
    if kind in _CODES or kind in _TIMES or "/" in kind or kind in ("string", "wstring"):
        return kind
    return f"{'std_msgs' if kind == 'Header' else within.rpartition('/')[0]}/{kind}"


def decoded(
    raws: list[bytes], find: Callable[[bytes], Layout], wanted: Callable[[str], bool]
) -> dict[str, Any]:
    """Wanted columns, each (n,), of n messages of a topic; those of each layout are decoded at once."""
    lengths, left = np.array([len(raw) for raw in raws]), np.arange(len(raws))
    found: dict[str, Any] = {}
    while len(left):
        first = raws[left[0]]
        one, of_length = find(first), np.flatnonzero(lengths[left] == len(first))
        alike = left[of_length]
        block = np.frombuffer(b"".join([raws[k] for k in alike]), np.uint8).reshape(len(alike), len(first))
        same = (block[:, one.keys] == block[0, one.keys]).all(axis=1)
        columns = one.decode(block[same], wanted)
        if same.sum() == len(raws):
            return columns
        for path, values in columns.items():
            found.setdefault(path, np.full(len(raws), np.nan))[alike[same]] = values
        left = np.delete(left, of_length[same])
    return found
