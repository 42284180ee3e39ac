"""Converts a log of JSON lines to MCAP, which Foxglove and other viewers show."""

from __future__ import annotations

import importlib
import json
import os
from typing import Any

from estimator.live.log import read

_LISTS = {"wrench": ["f_x", "f_y", "f_n", "tau", "tau_x", "tau_y"], "twist": ["v_x", "v_y", "omega"]}
_TYPES = {bool: "boolean", int: "integer", str: "string", list: "array", dict: "object"}


def convert(log: str | os.PathLike[str], target: str | os.PathLike[str]) -> int:
    """Writes every line of a log as a JSON message; the time of a message is its arrival.

    Args:
        log: From `slipgym live --log`.
        target: The MCAP file, which is replaced.

    Returns:
        How many messages were written.

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
