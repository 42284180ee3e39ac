"""Weights that are crafted or wrong are refused by name."""

import json
import struct

import numpy as np
import pytest
from safetensors.numpy import save

import policies
from policies.learned import files
from policies.learned.description import WEIGHTS


def changed(name, change):
    """Weights with one tensor changed; None takes it out."""

    def apply(tensors):
        if change is None:
            return {key: value for key, value in tensors.items() if key != name}
        return {**tensors, name: change(tensors.get(name))}

    return apply


def poisoned(value):
    def poison(tensor):
        out = tensor.copy()
        out.flat[0] = value
        return out

    return poison


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (changed("layers.0.bias", None), r"lacks the tensor 'layers\.0\.bias'"),
        (changed("extra", lambda _: np.zeros(3, np.float32)), r"holds the tensor 'extra'"),
        (changed("layers.0.weight", np.transpose), r"'layers\.0\.weight' is float32 \(\d+, 8\)"),
        (changed("layers.0.bias", lambda t: t.astype("f8")), r"'layers\.0\.bias' is float64"),
        (changed("layers.0.bias", lambda t: t.astype("f2")), r"'layers\.0\.bias' has type F16"),
        (changed("layers.0.bias", lambda t: t.astype("i8")), r"'layers\.0\.bias' has type I64"),
        (changed("layers.1.weight", poisoned(np.nan)), r"'layers\.1\.weight' holds numbers that are not"),
        (changed("observation.mean", poisoned(np.inf)), r"'observation\.mean' holds numbers that are not"),
        (changed("observation.var", poisoned(-1.0)), r"negative variance"),
    ],
)
def test_wrong_tensors_are_refused_by_name(policy_folder, replant, change, message):
    folder = policy_folder()
    _, tensors = files.read(folder)
    crafted = {name: np.ascontiguousarray(tensor) for name, tensor in change(tensors).items()}
    replant(folder, save(crafted))
    with pytest.raises(ValueError, match=message) as refused:
        policies.load(folder)
    assert str(folder / WEIGHTS) in str(refused.value)


def header(values, data=b""):
    text = json.dumps(values).encode()
    return struct.pack("<Q", len(text)) + text + data


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xff" * 8,
        struct.pack("<Q", 2**40) + b"{}",
        header({"a": {"dtype": "F32", "shape": [4], "data_offsets": [0, 16]}}),
        header({"a": {"dtype": "F32", "shape": [2**62, 8], "data_offsets": [0, 16]}}, bytes(16)),
        header({"a": {"dtype": "F32", "shape": [4], "data_offsets": [0, 8]}}, bytes(8)),
        header({"a": {"dtype": "F32", "shape": [1], "data_offsets": [4, 8]}}, bytes(8)),
    ],
    ids=["empty", "huge header", "cut header", "cut data", "overflow", "short", "hole"],
)
def test_crafted_safetensors_are_refused(policy_folder, replant, data):
    folder = policy_folder()
    replant(folder, data)
    with pytest.raises(ValueError, match=r"weights\.safetensors: is no safetensors file"):
        policies.load(folder)
