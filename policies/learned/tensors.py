"""The tensors of a policy: which there are, and how they are read."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from safetensors import SafetensorError, deserialize
from safetensors.numpy import save

from policies.learned.description import Description

_DTYPES = {"F32": np.dtype("<f4"), "F64": np.dtype("<f8")}

Shapes = dict[str, tuple[str, tuple[int, ...]]]
"""Name -> type as safetensors calls it, and shape."""


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


def pack(tensors: Mapping[str, np.ndarray]) -> bytes:
    """Tensors as the content of a safetensors file."""
    return save({name: np.asarray(tensor, order="C") for name, tensor in tensors.items()})


def unpack(data: bytes) -> dict[str, np.ndarray]:
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


def check(tensors: Mapping[str, np.ndarray], shapes: Shapes) -> None:
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
