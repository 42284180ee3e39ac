"""The folder of a policy and the tensors in it: written whole, read with suspicion."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError
from safetensors import SafetensorError, deserialize
from safetensors.numpy import save

from estimator.plain_files import content
from policies.learned.description import FORMAT, TRAINING, WEIGHTS, Description
from slipgym.atomic_io import new_folder
from slipgym.config.errors import explain, unknown

DESCRIPTION = "policy.json"
_LIMITS = {DESCRIPTION: 2**20, WEIGHTS: 2**26, TRAINING: 2**28}
"""Largest size of a file [bytes]."""
_DTYPES = {"F32": np.dtype("<f4"), "F64": np.dtype("<f8")}

Shapes = dict[str, tuple[str, tuple[int, ...]]]
"""Name -> type as safetensors calls it, and shape."""


def write(
    path: str | os.PathLike[str],
    description: Mapping[str, Any],
    weights: Mapping[str, np.ndarray],
    training: Mapping[str, np.ndarray] | None = None,
) -> Path:
    """Writes the folder of a policy; it appears when it is complete, or not at all.

    The description is as in `Description`, without `format` and `files`; it acts with the weights, `training`
    is all that training adapts.

    Raises:
        FileExistsError: Something is there already.
        ValueError: The parts do not make a policy that `read` would accept.
    """
    contents = {WEIGHTS: _pack(weights)}
    if training is not None:
        contents[TRAINING] = _pack(training)
    hashes = {name: _sha256(data) for name, data in contents.items()}
    text = json.dumps({"format": FORMAT, **description, "files": hashes}, indent=2, ensure_ascii=False)
    with new_folder(Path(path)) as folder:
        for name, data in {**contents, DESCRIPTION: f"{text}\n".encode()}.items():
            (folder / name).write_bytes(data)
        for name in contents:
            read(folder, name)
    return Path(path)


def read_description(path: str | os.PathLike[str]) -> Description:
    """Reads policy.json of a folder.

    Raises:
        FileNotFoundError: There is nothing at the path.
        ValueError: What lies there is no policy; the message names the file and what is wrong.
    """
    folder = Path(path)
    if not folder.exists():
        raise FileNotFoundError(f"there is nothing at {os.fspath(path)!r}")
    if not folder.is_dir():
        raise ValueError(f"{folder} is a file; a policy is a folder that holds {DESCRIPTION} and {WEIGHTS}")
    data, file = _content(folder, DESCRIPTION), folder / DESCRIPTION
    try:
        values = json.loads(data, object_pairs_hook=_once, parse_constant=_refuse)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{file}: is no JSON: {error}") from error
    found = values.get("format") if isinstance(values, dict) else None
    if type(found) is not int or found != FORMAT:
        raise ValueError(f"{file}: format = {found!r} is unknown; this version of slipgym reads {FORMAT}")
    try:
        return Description.model_validate(values)
    except ValidationError as error:
        raise explain(error, lambda _: os.fspath(file), Description) from error


def read(path: str | os.PathLike[str], name: str = WEIGHTS) -> tuple[Description, dict[str, np.ndarray]]:
    """Reads the description of a policy and a file of its tensors, WEIGHTS or TRAINING.

    Those of WEIGHTS are checked to be the network's.

    Raises:
        FileNotFoundError: There is nothing at the path.
        ValueError: What lies there is no policy, or not whole, or was changed; the message names the file
            and what is wrong.
    """
    description, file = read_description(path), Path(path) / name
    if name not in description.files:
        raise ValueError(f"{Path(path) / DESCRIPTION}: {unknown('file', name, description.files)}")
    data = _content(Path(path), name)
    if _sha256(data) != description.files[name]:
        raise ValueError(
            f"{file}: its SHA-256 is {_sha256(data)}, {DESCRIPTION} has {description.files[name]}"
        )
    try:
        found = _unpack(data)
        if name == WEIGHTS:
            _check(found, expected(description))
    except ValueError as error:
        raise ValueError(f"{file}: {error}") from error
    return description, found


def _content(folder: Path, name: str) -> bytes:
    """All of a regular file of bearable size."""
    file, limit = folder / name, _LIMITS[name]
    if not file.exists():
        raise ValueError(f"{folder} is no policy: it lacks {name}")
    return content(file, limit)


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) < len(pairs):
        names = [name for name, _ in pairs]
        raise ValueError(f"duplicate key {next(name for name in names if names.count(name) > 1)!r}")
    return values


def _refuse(constant: str) -> None:
    raise ValueError(f"{constant} is no number of JSON")


def expected(description: Description) -> Shapes:
    """The tensors that make a policy act.

    Dense layers are y = weight x + bias; the last one gives the action. Those of an LSTM layer hold the
    rows of input, forget, cell and output gate, in this order, as in torch.
    """
    environment, network = description.environment, description.network
    width = description.environment.width
    found: Shapes = {}
    if description.normalisation is not None:
        found = {f"observation.{name}": ("F64", (width,)) for name in ("mean", "var")}
    if network.memory is not None:
        size = network.memory.size
        for k in range(network.memory.layers):
            found[f"memory.{k}.input_weight"] = ("F32", (4 * size, width))
            found[f"memory.{k}.hidden_weight"] = ("F32", (4 * size, size))
            found[f"memory.{k}.input_bias"] = found[f"memory.{k}.hidden_bias"] = ("F32", (4 * size,))
            width = size
    for k, rows in enumerate((*network.layers, len(environment.action))):
        found[f"layers.{k}.weight"] = ("F32", (rows, width))
        found[f"layers.{k}.bias"] = ("F32", (rows,))
        width = rows
    return found


def _pack(tensors: Mapping[str, np.ndarray]) -> bytes:
    """Tensors as the content of a safetensors file."""
    return save({name: np.asarray(tensor, order="C") for name, tensor in tensors.items()})


def _unpack(data: bytes) -> dict[str, np.ndarray]:
    """The tensors in the content of a safetensors file, whichever they are; reads numbers only.

    Raises:
        ValueError: It is none, or holds other types than float32 and float64, or numbers that are not finite.
    """
    try:
        found = dict(deserialize(data))
    except SafetensorError as error:
        raise ValueError(f"is no safetensors file: {error}") from error
    tensors = {}
    for name, tensor in sorted(found.items()):
        if tensor["dtype"] not in _DTYPES:
            raise ValueError(f"{name!r} has type {tensor['dtype']}, not one of {', '.join(_DTYPES)}")
        tensors[name] = np.frombuffer(tensor["data"], _DTYPES[tensor["dtype"]]).reshape(tensor["shape"])
        if not np.isfinite(tensors[name]).all():
            raise ValueError(f"{name!r} holds numbers that are not finite")
    return tensors


def _check(tensors: Mapping[str, np.ndarray], shapes: Shapes) -> None:
    """Refuse tensors that are not exactly those expected.

    Raises:
        ValueError: One is missing, too many, or of another type or shape, or a variance is negative.
    """
    for name in (name for name in shapes if name not in tensors):
        raise ValueError(f"lacks the tensor {name!r}")
    for name in sorted(name for name in tensors if name not in shapes):
        raise ValueError(f"holds the tensor {name!r}, which the network of policy.json has not")
    for name, (kind, shape) in shapes.items():
        tensor = tensors[name]
        if tensor.dtype != _DTYPES[kind] or tensor.shape != shape:
            raise ValueError(
                f"{name!r} is {tensor.dtype} {tensor.shape}, policy.json needs {_DTYPES[kind]} {shape}"
            )
    if np.any(tensors.get("observation.var", 0.0) < 0.0):
        raise ValueError("'observation.var' holds a negative variance")
