"""Reads MCAP files and bags of ROS 1 and ROS 2 as a table for each topic; ROS need not be installed."""

from __future__ import annotations

import io
import json
import struct
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from estimator.records.columns import Wanted, is_wanted
from estimator.records.extras import extra
from estimator.records.messages import Layout, decoded, definitions
from estimator.records.sources import LARGEST
from estimator.records.table import Table
from estimator.suggestions import brief

_STAMPS = "header.stamp", "stamp"
"""Fields that are the time of a message, where they are filled in."""
_AT_ONCE = 2**15
"""Messages that are decoded together."""
_Kind = tuple[str, str, str]
"""How messages are written: encoding (cdr, ros1 or json), name of the type, text of its definition."""


class _Topic:
    """Collects the messages of a topic as columns.

    Raises:
        ValueError: Its messages cannot be decoded.
    """

    def __init__(self, name: str, kind: _Kind, wanted: Wanted, first: bytes) -> None:
        self._name, self._wanted = name, wanted
        self._raws: list[bytes] = []
        self._stamps: list[int] = []
        self._pieces: list[dict[str, Any]] = []
        self._names: dict[str, None] = {}
        encoding, type_, definition = kind
        if encoding == "json":
            self._decode: Callable[[list[bytes]], dict[str, Any]] = self._json
        elif encoding in ("cdr", "ros1") and definition:
            layout = partial(Layout, definitions(definition, type_), type_, encoding == "cdr")
            self._decode = partial(self._ros, layout)
        else:
            raise ValueError(
                f"{name}: no definition of ROS, and no JSON, says what a message {brief(type_)} in the "
                f"encoding {brief(encoding)} is; `ros2 bag convert` to MCAP adds the definitions"
            )
        self._decode([first])
        self.asked = any(is_wanted(each, wanted) for each in self._names)

    def add(self, stamp: int, raw: bytes) -> None:
        """Takes a message and the time at which it was logged [ns]."""
        if not self.asked:
            return
        self._raws.append(raw)
        self._stamps.append(stamp)
        if len(self._raws) == _AT_ONCE:
            self._flush()

    def table(self) -> Table:
        """The columns, in order of time: that of the header, where it is filled in, else that of the log."""
        self._flush()
        pandas = extra("pandas")
        if not self._pieces:
            return Table(pandas.DataFrame(), ["t", "t_log", *self._names])
        frame = pandas.concat([pandas.DataFrame(piece) for piece in self._pieces], ignore_index=True)
        self._pieces = []
        logged = frame.pop("")
        stamp = next((frame[path] for path in _STAMPS if path in frame), None)
        frame.columns = [f"{self._name}.{path}" for path in frame.columns]
        frame["t"] = logged if stamp is None or not (stamp > 0.0).all() else stamp
        frame["t_log"] = logged
        if not frame["t"].is_monotonic_increasing:
            frame = frame.sort_values("t", kind="stable", ignore_index=True)
        return Table(frame, ["t", "t_log", *self._names], joints=True)

    def _asks(self, path: str) -> bool:
        full = f"{self._name}.{path}"
        self._names[full] = None
        return path in _STAMPS or is_wanted(full, self._wanted)

    def _flush(self) -> None:
        if self._raws:
            found = self._decode(self._raws)
            self._pieces.append({**found, "": np.array(self._stamps, np.int64) / 1e9})
            self._raws, self._stamps = [], []

    def _ros(self, layout: Callable[[bytes], Layout], raws: list[bytes]) -> dict[str, Any]:
        try:
            return decoded(raws, layout, self._asks)
        except ValueError as error:
            raise ValueError(f"{self._name}: {error}") from error

    def _json(self, raws: list[bytes]) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for k, raw in enumerate(raws):
            for path, value in _leaves(json.loads(raw), ""):
                if self._asks(path):
                    found.setdefault(path, np.full(len(raws), np.nan))[k] = value
        return found


def read_bag(path: Path, wanted: Wanted) -> list[Table]:
    """Reads the topics that have a column which is asked for.

    Args:
        path: A file .mcap, .bag or .db3, or the folder of a ROS 2 bag.
        wanted: Columns: /topic.field.field, an element as field[2], or as effort[joint].

    Raises:
        ValueError: A message is damaged, a topic that is asked for cannot be decoded, or none can.
    """
    topics: dict[str, _Topic] = {}
    refused: dict[str, ValueError] = {}
    for name, kind, stamp, raw in _of_mcap(path) if path.suffix.lower() == ".mcap" else _of_rosbag(path):
        if name not in topics and name not in refused:
            try:
                topics[name] = _Topic(name, kind, wanted, raw)
            except ValueError as error:
                refused[name] = error
                if wanted is not None and any(each.startswith(f"{name}.") for each in wanted):
                    raise
        if name in topics:
            topics[name].add(stamp, raw)
    if not topics:
        raise next(iter(refused.values()), ValueError("it has no messages"))
    return [topic.table() for topic in topics.values()]


def _leaves(value: Any, path: str) -> Iterator[tuple[str, float]]:
    """The numbers of a JSON value, with their paths."""
    if isinstance(value, dict):
        for name, inner in value.items():
            yield from _leaves(inner, f"{path}.{name}" if path else name)
    elif isinstance(value, list) and len(value) <= LARGEST:
        for k, inner in enumerate(value):
            yield from _leaves(inner, f"{path}[{k}]")
    elif isinstance(value, int | float):
        yield path, value


_Messages = Iterator[tuple[str, _Kind, int, bytes]]
"""Topic, kind, time of the log [ns] and bytes of each message."""


def _of_mcap(path: Path) -> _Messages:
    """Reads chunks in the order of the file: taking messages apart here is five times as fast as in mcap."""
    reader, of, kinds, schemas = extra("mcap.stream_reader"), extra("mcap.records"), {}, {}
    with path.open("rb") as file:
        for record in reader.StreamReader(file, emit_chunks=True).records:
            for found in _in_chunk(record) if isinstance(record, of.Chunk) else [record]:
                if isinstance(found, of.Message):
                    found = found.channel_id, found.log_time, found.data
                if isinstance(found, tuple):
                    channel, stamp, raw = found
                    yield *kinds[channel], stamp, raw
                elif isinstance(found, of.Schema):
                    known = found.encoding in ("ros1msg", "ros2msg")
                    schemas[found.id] = found.name, found.data.decode() if known else ""
                elif isinstance(found, of.Channel):
                    schema = schemas.get(found.schema_id, ("", ""))
                    kinds[found.id] = found.topic, (found.message_encoding, *schema)


def _in_chunk(chunk: Any) -> Iterator[Any]:
    """Its schemas and channels, and of each message the channel, the time [ns] and the bytes."""
    reader, records = extra("mcap.stream_reader"), extra("mcap.records")
    stream, size = reader.get_chunk_data_stream(chunk)
    data, at = stream.read(size), 0
    while at < size:
        kind, length = _RECORD.unpack_from(data, at)
        at, begin = at + _RECORD.size + length, at + _RECORD.size
        if kind == _MESSAGE:
            channel, _, stamp, _ = _HEAD.unpack_from(data, begin)
            yield channel, stamp, data[begin + _HEAD.size : at]
        elif kind in _NAMED:
            content = extra("mcap.data_stream").ReadDataStream(io.BytesIO(data[begin:at]))
            yield getattr(records, _NAMED[kind]).read(content)


_RECORD, _HEAD = struct.Struct("<BQ"), struct.Struct("<HIQQ")
_MESSAGE, _NAMED = 5, {3: "Schema", 4: "Channel"}
"""Codes of records, by the specification of MCAP."""


def _of_rosbag(path: Path) -> _Messages:
    extra("rosbags.typesys")
    one = path.suffix.lower() == ".bag"
    with extra("rosbags.rosbag1" if one else "rosbags.rosbag2").Reader(path) as reader:
        kinds = {each.id: _of_connection(each, "ros1" if one else "cdr") for each in reader.connections}
        for connection, stamp, raw in reader.messages():
            yield connection.topic, kinds[connection.id], stamp, bytes(raw)


def _of_connection(connection: Any, encoding: str) -> _Kind:
    """Bags of ROS 2 in SQLite before Iron have no definitions: those of its own messages are known."""
    definition, kind = connection.msgdef, connection.msgtype
    if definition.format.name == "MSG":
        return encoding, kind, definition.data
    stores = extra("rosbags.typesys")
    try:
        text = stores.get_typestore(stores.Stores.LATEST).generate_msgdef(kind, ros_version=2)[0]
    except Exception:  # of its own kinds: the type is unknown
        text = ""
    return encoding, kind, text
