"""Nested plain data as one file, without pickle: what is read back can run no code.

A file is an uncompressed zip: `tree.json`, the arrays as `<k>.npy`, and `sums.json` with the SHA-256 of each
of them. It is whole or it does not open.
"""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from estimator.plain_files import check_regular
from slipgym import atomic_io
from slipgym.envs.states import EnvState, SimulationState, VectorState
from slipgym.world.plant import Plant
from slipgym.world.scene import Box, EngineState

_RECORDS = {
    record.__name__: record for record in (EnvState, VectorState, SimulationState, EngineState, Box, Plant)
}


def write(path: Path, tree: Any) -> None:
    """Writes a tree of mappings, lists, tuples, records of an environment's state, arrays, bytes and scalars.

    The file appears whole under its name, or not at all; what was there is replaced.

    Raises:
        TypeError: Something in the tree is none of these.
        OSError: It cannot be written.
    """
    arrays: list[np.ndarray] = []
    members = {"tree.json": json.dumps(_encoded(tree, arrays)).encode()}
    for k, array in enumerate(arrays):
        buffer = io.BytesIO()
        np.lib.format.write_array(buffer, array, allow_pickle=False)
        members[f"{k}.npy"] = buffer.getvalue()
    sums = {name: hashlib.sha256(content).hexdigest() for name, content in members.items()}
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for name, member in {**members, "sums.json": json.dumps(sums).encode()}.items():
            archive.writestr(zipfile.ZipInfo(name), member)
    atomic_io.write(path, content.getvalue())


def read(path: Path) -> Any:
    """Reads what `write` wrote.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: It is damaged or no such file.
    """
    check_regular(path)
    try:
        with zipfile.ZipFile(path) as archive:
            packed = [entry.filename for entry in archive.infolist() if entry.compress_type]
            if packed:
                raise ValueError(f"{packed[0]!r} is compressed")
            # what is stored as it is cannot be larger than the file
            if sum(entry.file_size for entry in archive.infolist()) > path.stat().st_size:
                raise ValueError("its parts overlap")
            members = {name: archive.read(name) for name in archive.namelist()}
        sums = json.loads(members.pop("sums.json"))
        if sums != {name: hashlib.sha256(content).hexdigest() for name, content in members.items()}:
            raise ValueError("a checksum differs")
        return _decoded(json.loads(members["tree.json"]), members)
    except OSError:
        raise
    except Exception as error:  # no zip, an encrypted one, or no tree as `write` writes it
        raise ValueError(f"{path} is damaged: {error}") from error


def _encoded(value: Any, arrays: list[np.ndarray]) -> Any:
    if value is None or isinstance(value, bool | str) or type(value) in (int, float):
        return value
    if isinstance(value, np.ndarray | np.generic):
        arrays.append(np.asarray(value))
        return {"array": len(arrays) - 1}
    if isinstance(value, bytes):
        arrays.append(np.frombuffer(value, np.uint8))
        return {"bytes": len(arrays) - 1}
    if isinstance(value, list | tuple):
        return {type(value).__name__: [_encoded(item, arrays) for item in value]}
    if isinstance(value, Mapping):
        return {"mapping": [[_encoded(key, arrays), _encoded(item, arrays)] for key, item in value.items()]}
    if is_dataclass(value) and type(value).__name__ in _RECORDS:
        values = {field.name: getattr(value, field.name) for field in fields(value)}
        return {"record": type(value).__name__, "values": _encoded(values, arrays)}
    raise TypeError(f"cannot write a {type(value).__name__} as plain data")


def _decoded(node: Any, members: Mapping[str, bytes]) -> Any:
    if not isinstance(node, dict):
        return node
    if "record" in node:
        return _RECORDS[node["record"]](**_decoded(node["values"], members))
    ((kind, content),) = node.items()
    if kind == "mapping":
        return {_decoded(key, members): _decoded(item, members) for key, item in content}
    if kind in ("list", "tuple"):
        items = (_decoded(item, members) for item in content)
        return list(items) if kind == "list" else tuple(items)
    array = np.lib.format.read_array(io.BytesIO(members[f"{content}.npy"]), allow_pickle=False)
    return array.tobytes() if kind == "bytes" else array
