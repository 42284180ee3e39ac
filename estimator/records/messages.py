"""Reads recorded messages: MCAP files, and bags of ROS 1 and ROS 2; no ROS is needed.

A message is a row and its numbers are columns `<topic>.<field>.<field>`; the cells of all other topics are
empty in that row. Arrays of up to 16 numbers have a column for each, `position[0]`, or `position[<name>]`
where the message has names (JointState). Two columns have times: `t`, the message's own stamp if it has
one, and `t_log`, when it was recorded.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from estimator.records.extras import extra

OWN, LOGGED = "t", "t_log"
"""Columns of times [s]."""
_LONGEST = 16
"""Longest array whose numbers are columns; longer ones are pictures, maps of pressure, point clouds."""
_DEEPEST = 8


FILES = ".mcap", ".bag"


class _Message(NamedTuple):
    topic: str
    logged: int  # [ns]
    content: Any


def read_messages(path: Path, wanted: set[str] | None) -> Any:
    """Reads the topics that a mapping names.

    Args:
        path: An mcap or bag file, or the folder of a bag of ROS 2.
        wanted: Names of columns; None: all topics. Where no topic has any of them, the frame has the names of
            all columns and no rows.

    Returns:
        A pandas.DataFrame, in the order of the own time.

    Raises:
        Exception: Whatever the reader of a damaged file raises.
        ModuleNotFoundError: A package is not installed.
    """
    pandas = extra("pandas")
    rows: dict[str, list[dict[str, float]]] = {}
    seen: dict[str, None] = {}

    def asked(topic: str) -> bool:
        return wanted is None or any(name.startswith(f"{topic}.") for name in wanted)

    for message in _messages(path):
        topic = message.topic
        if not asked(topic):
            if not any(name.startswith(f"{topic}.") for name in seen):
                seen.update(dict.fromkeys(_row(message)))
            continue
        rows.setdefault(topic, []).append(_row(message))
    if not rows:
        return pandas.DataFrame(columns=list(seen))
    frame = pandas.concat([pandas.DataFrame(each) for each in rows.values()], ignore_index=True)
    return frame.sort_values(OWN, kind="stable", ignore_index=True)


def _row(message: _Message) -> dict[str, float]:
    found: dict[str, float] = {}
    _flatten(message.topic, message.content, found, 0)
    logged = 1e-9 * message.logged
    return {OWN: _stamp(message.content) or logged, LOGGED: logged, **found}


def _flatten(name: str, value: Any, found: dict[str, float], depth: int) -> None:
    if isinstance(value, int | float | np.number):
        found[name] = float(value)
    elif isinstance(value, list | tuple | np.ndarray):
        _flatten_array(name, value, None, found)
    elif not isinstance(value, str | bytes | None) and depth < _DEEPEST:
        fields = _fields(value)
        for key, each in fields.items():
            if isinstance(each, list | tuple | np.ndarray):
                _flatten_array(f"{name}.{key}", each, fields.get("name"), found)
            elif key != "header":
                _flatten(f"{name}.{key}", each, found, depth + 1)


def _flatten_array(name: str, values: Any, names: Any, found: dict[str, float]) -> None:
    if not 0 < len(values) <= _LONGEST or not all(
        isinstance(each, int | float | np.number) for each in values
    ):
        return
    named = isinstance(names, list | tuple | np.ndarray) and len(names) == len(values)
    for k, each in enumerate(values):
        found[f"{name}[{names[k] if named else k}]"] = float(each)


def _fields(value: Any) -> dict[str, Any]:
    """Fields of a decoded message, whichever library made it."""
    if isinstance(value, dict):
        return value
    names = getattr(value, "__dataclass_fields__", None) or getattr(value, "__slots__", ())
    return {name: getattr(value, name) for name in names if not name.startswith("_")}


def _stamp(content: Any) -> float | None:
    """Time in the header of a message [s]; None: it has none, or nobody set it."""
    stamp = _fields(_fields(content).get("header")).get("stamp")
    if stamp is None and isinstance(content, dict):
        own = content.get("stamp")
        return float(own) if isinstance(own, int | float) else None
    fields = _fields(stamp)
    nanoseconds = fields.get("nanosec", fields.get("nsec", fields.get("nsecs", 0)))
    seconds = fields.get("sec", fields.get("secs", 0))
    return seconds + 1e-9 * nanoseconds or None


def _messages(path: Path) -> Iterator[_Message]:
    return _mcap(path) if path.suffix.lower() == ".mcap" else _bag(path)


def _mcap(path: Path) -> Iterator[_Message]:
    make_reader = extra("mcap.reader", "records").make_reader
    ros2 = extra("mcap_ros2.decoder", "records").DecoderFactory()
    decoders: dict[int, Any] = {}
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages(log_time_order=True):
            if channel.id not in decoders:
                made = ros2.decoder_for(channel.message_encoding, schema)
                decoders[channel.id] = made or (json.loads if channel.message_encoding == "json" else None)
            decode = decoders[channel.id]
            if decode is not None:
                yield _Message(channel.topic, message.log_time, decode(message.data))


def _bag(path: Path) -> Iterator[_Message]:
    typesys, highlevel = extra("rosbags.typesys", "records"), extra("rosbags.highlevel", "records")
    default = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
    with highlevel.AnyReader([path], default_typestore=default) as reader:
        for connection, logged, data in reader.messages():
            yield _Message(connection.topic, logged, reader.deserialize(data, connection.msgtype))


def is_bag(path: Path) -> bool:
    """Whether a path is a folder that holds a bag of ROS 2."""
    try:
        return (path / "metadata.yaml").is_file()
    except OSError:  # a name that is too long
        return False
