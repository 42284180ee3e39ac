"""Decodes messages of ROS 1 and ROS 2 by the definitions that a bag has; nothing is generated or executed.

Messages of sensors have the same layout each time, so that the places of all numbers are found in the first
one, and thousands of messages are then decoded at once.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
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
    """The fields of a type of messages, and of those in it.

    Args:
        text: Its definition, with those of others below lines of = and `MSG: package/Type`.
        name: Its name, as geometry_msgs/msg/Wrench.
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


@dataclass
class Layout:
    """Places of the numbers in a message."""

    length: int
    """Of a message [bytes]."""
    order: str = "<"
    """Order of its bytes."""
    places: dict[str, tuple[str, int]] = field(default_factory=dict)
    """Path of a field -> its type and its first byte; the type "t" is a time."""
    keys: list[int] = field(default_factory=list)
    """Bytes that messages of the same layout have in common: lengths, and names of joints."""

    def decode(self, block: Any, wanted: Callable[[str], bool]) -> dict[str, Any]:
        """Columns of messages of this layout, each (n,).

        Args:
            block: Their bytes, (n, length).
            wanted: Whether a path is asked for.
        """

        def column(code: str, at: int) -> Array:
            dtype = np.dtype(self.order + code)
            cells = np.ascontiguousarray(block[:, at : at + dtype.itemsize]).view(dtype)[:, 0]
            return cells.astype(dtype.newbyteorder("="))

        found = {}
        for path, (code, at) in self.places.items():
            if wanted(path) and code == "t":
                found[path] = (column("i4", at) * np.int64(10**9) + column("u4", at + 4)) / 1e9
            elif wanted(path):
                found[path] = column(code, at)
        return found


class _Walk:
    """Goes through one message, in the order of its bytes."""

    def __init__(self, defined: Definitions, raw: bytes, cdr: bool) -> None:
        if cdr and (len(raw) < 4 or raw[0] or raw[1] > 1):
            raise ValueError(f"the encoding {brief(raw[:4].hex())} of a message is not plain CDR")
        self._defined, self._raw, self._cdr = defined, raw, cdr
        self._values = 0
        self.layout = Layout(len(raw), ">" if cdr and raw[1] == 0 else "<")
        self._at = 4 if cdr else 0

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
        self.layout.keys += range(at, at + 4)
        return int.from_bytes(self._raw[at : at + 4], "little" if self.layout.order == "<" else "big")

    def _text(self, key: bool) -> str:
        n = self._count()
        at = self._take(n, 1)
        if key:
            self.layout.keys += range(at, at + n)
        return self._raw[at : at + n].rstrip(b"\0").decode("utf-8", "replace")

    def one(self, kind: str, path: str, depth: int = 0) -> None:
        """A value of any type but a text."""
        places, self._values = self.layout.places, self._values + 1
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
                self.one(_absolute(inner, kind), below, depth + 1)
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
                    self.one(_absolute(inner, kind), each, depth + 1)

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


def layout(defined: Definitions, kind: str, raw: bytes, cdr: bool) -> Layout:
    """Finds where the numbers of a message are.

    Args:
        defined: Its definitions.
        kind: Its type.
        raw: Its bytes.
        cdr: Whether it is of ROS 2.

    Raises:
        ValueError: The definition does not fit, or is not one of these encodings.
    """
    walk = _Walk(defined, raw, cdr)
    walk.one(kind.replace("/msg/", "/"), "")
    return walk.layout


def decoded(
    raws: list[bytes], find: Callable[[bytes], Layout], wanted: Callable[[str], bool]
) -> Iterator[tuple[Any, Mapping[str, Any]]]:
    """Decodes messages of one topic, those of each layout at once.

    Args:
        raws: Their bytes, (n,).
        find: Gives the layout of one of them.
        wanted: Whether a path is asked for.

    Yields:
        Places among them, (k,), and their columns, each (k,).
    """
    lengths, left = np.array([len(raw) for raw in raws]), np.arange(len(raws))
    while len(left):
        one = find(raws[left[0]])
        of_length = np.flatnonzero(lengths[left] == one.length)
        alike = left[of_length]
        block = np.frombuffer(b"".join([raws[k] for k in alike]), np.uint8).reshape(len(alike), one.length)
        same = (block[:, one.keys] == block[0, one.keys]).all(axis=1)
        yield alike[same], one.decode(block[same], wanted)
        left = np.delete(left, of_length[same])
