import hashlib
import json

import numpy as np
import pytest

from policies.learned import files
from policies.learned.description import WEIGHTS, Description
from policies.learned.files import expected
from policies.learned.fitting import column_of
from slipgym.config import load
from slipgym.envs.actions import components
from slipgym.envs.observation import columns
from slipgym.tasks import TASKS


def describe(task="Hold", friction_source="estimated", action_mode="grip_force", **changes):
    """What policy.json says, without `format` and `files`."""
    observed = columns(load(), TASKS[task], friction_source, action_mode)
    values = {
        "environment": {
            "id": f"slipgym/{task}-v0",
            "arguments": {"friction_source": friction_source, "action_mode": action_mode},
            "rate": 120.0,
            "history": 0,
            "observation": [column_of(column).model_dump() for column in observed],
            "action": [column_of(column).model_dump() for column in components(action_mode, load())],
        },
        "network": {"kind": "mlp", "memory": None, "layers": [8, 6], "activation": "tanh", "squash": False},
        "normalisation": {"clip": 10.0, "epsilon": 1e-8},
        "residual": None,
        "origin": {
            "algorithm": "PPO",
            "command": "python train.py",
            "steps": 1000,
            "seeds": [1],
            "versions": {"numpy": "2"},
            "critic": None,
        },
    }
    for key, change in changes.items():
        values[key] = {**(values[key] or {}), **change} if isinstance(change, dict) else change
    return values


def drawn(description, seed=0):
    """Weights at random, of the size that trained ones have."""
    rng = np.random.default_rng(seed)
    hashes = {files.WEIGHTS: "0" * 64}
    weights = {}
    for name, (kind, shape) in expected(
        Description.model_validate({"format": 1, **description, "files": hashes})
    ).items():
        values = rng.normal(size=shape) * (0.1 if len(shape) == 1 else shape[-1] ** -0.5)
        weights[name] = values.astype("f4" if kind == "F32" else "f8")
    if "observation.var" in weights:
        weights["observation.var"] = rng.uniform(0.1, 2.0, weights["observation.var"].shape)
    return weights


@pytest.fixture
def policy_folder(tmp_path):
    """Writes policies with weights at random."""

    def write(name="policy", seed=0, weights=None, **changes):
        description = describe(**changes)
        given = {**drawn(description, seed), **(weights or {})}
        return files.write(tmp_path / name, description, given)

    return write


@pytest.fixture
def lstm():
    """Changes of a description that make a network with two LSTM layers."""
    memory = {"size": 5, "layers": 2}
    return {
        "network": {"kind": "lstm", "memory": memory, "layers": [8], "activation": "relu", "squash": True}
    }


@pytest.fixture
def mark(tmp_path):
    """A file that a crafted one would write; it is not there when the test is over."""
    path = tmp_path / "executed"
    yield path
    assert not path.exists()


@pytest.fixture
def rewrite():
    """Changes policy.json of a folder."""

    def apply(folder, change):
        values = json.loads((folder / files.DESCRIPTION).read_text())
        change(values)
        (folder / files.DESCRIPTION).write_text(json.dumps(values))

    return apply


@pytest.fixture
def replant(rewrite):
    """Replaces a file, with its checksum: the work of someone who means it."""

    def apply(folder, data, name=WEIGHTS):
        (folder / name).write_bytes(data)
        rewrite(folder, lambda v: v["files"].update({name: hashlib.sha256(data).hexdigest()}))

    return apply
