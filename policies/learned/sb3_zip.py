"""A zip of Stable-Baselines3 as a policy's folder, without executing anything that lies in it.

`model.save` writes pickles beside the tensors, and `PPO.load` executes them. Here only the tensors of
`policy.pth` are read, by torch's reader of plain tensors (`weights_only=True`), and three plain values of
`data`: the number of steps, whether exploration was state-dependent, and the name of the activation. Needs
the extra `train`.
"""

from __future__ import annotations

import io
import json
import os
import re
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from estimator.plain_files import check_regular
from policies.learned import files
from policies.learned.export import described, origin
from policies.learned.extract import ACTIVATIONS, acting_places, array
from slipgym.atomic_io import check_folder
from slipgym.config.errors import unknown

LIMIT = 2**28
"""Most bytes of a member of the zip."""
_WEIGHTS, _DATA = "policy.pth", "data"
_ACTIVATION = re.compile(r"<class 'torch\.nn\.modules\.activation\.(\w+)'>")


def import_zip(
    source: str | os.PathLike[str],
    path: str | os.PathLike[str],
    environment: str,
    arguments: Mapping[str, Any],
) -> Path:
    """Writes a folder at `path` from a zip that `model.save` of PPO, SAC, TQC or RecurrentPPO wrote.

    A `VecNormalize` is not part of such a zip: a policy that was trained with one does not act well without
    it. `policies.learned.export.save`, called where it was trained, keeps it.

    The environment it was trained in is given by id, such as "slipgym/Hold-v0", and keyword arguments.

    Raises:
        FileNotFoundError: There is no zip.
        FileExistsError: Something is at `path` already.
        OSError: The folder cannot be written.
        ValueError: It is no such zip, its network is none that a file can hold, or not of this environment.
    """
    source = Path(source)
    check_regular(source)
    if os.path.exists(path):
        raise FileExistsError(f"{path} exists already")
    check_folder(Path(path))
    try:
        with zipfile.ZipFile(source) as archive:
            data, tensors = _plain(_member(archive, _DATA)), _tensors(_member(archive, _WEIGHTS))
    except zipfile.BadZipFile as error:
        raise ValueError(f"{source}: is no zip of Stable-Baselines3: {error}") from error
    except ValueError as error:
        raise ValueError(f"{source}: {error}") from error
    kind = "PPO" if "action_net.weight" in tensors else "SAC"
    if kind == "SAC" and data["use_sde"]:
        raise ValueError(f"{source}: use_sde = True: what SAC then acts with has no file format")
    weights = {}
    for ours, theirs in acting_places(tensors).items():
        value, axes = tensors.get(theirs), 1 if ours.endswith("bias") else 2
        if value is None or value.ndim != axes:
            raise ValueError(f"{source}: {_WEIGHTS!r} has no {theirs} of {axes} axes")
        weights[ours] = value
    stacked = [value.shape[1] for name, value in weights.items() if name.endswith("hidden_weight")]
    layers = [len(value) for name, value in weights.items() if re.match(r"layers\..*bias", name)]
    where = described(environment, arguments)
    reads, acts = (where["history"] + 1) * len(where["observation"]), len(where["action"])
    first = "memory.0.input_weight" if stacked else "layers.0.weight"
    sizes = ("observation", weights[first].shape[1], reads), ("action", layers[-1], acts)
    for what, found, wanted in sizes:
        if found != wanted:
            message = f"the model's {what} has {found} numbers, that of {environment} {wanted}"
            raise ValueError(f"{source}: {message}")
    algorithm = "RecurrentPPO" if stacked else kind
    description = {
        "environment": where,
        "network": {
            "kind": "lstm" if stacked else "mlp",
            "memory": {"size": stacked[0], "layers": len(stacked)} if stacked else None,
            "layers": layers[:-1],
            "activation": data["activation"] or {"PPO": "tanh", "SAC": "relu"}[kind],
            "squash": kind == "SAC",
        },
        "normalisation": None,
        "origin": origin(algorithm, f"imported from {source.name}", data["steps"], [], critic=None),
    }
    return files.write(path, description, weights)


def _member(archive: zipfile.ZipFile, name: str) -> bytes:
    """A member of bearable size."""
    if name not in archive.namelist():
        raise ValueError(f"holds no {name!r}; it is none of Stable-Baselines3's zips")
    with archive.open(name) as stream:
        found = stream.read(LIMIT + 1)
    if len(found) > LIMIT:
        raise ValueError(f"{name!r} is larger than the {LIMIT} bytes allowed")
    return found


def _plain(text: bytes) -> dict[str, Any]:
    """The plain values of `data` that are needed."""
    try:
        found = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"'data' is no JSON: {error}") from error
    if not isinstance(found, dict):
        raise ValueError("'data' is no mapping")
    steps, keywords = found.get("num_timesteps"), found.get("policy_kwargs")
    if type(steps) is not int or steps < 0:
        raise ValueError(f"num_timesteps = {steps!r} of 'data' must be a whole number >= 0")
    activation = keywords.get("activation_fn") if isinstance(keywords, dict) else None
    if activation is not None:
        match = _ACTIVATION.fullmatch(activation) if isinstance(activation, str) else None
        if match is None or match[1] not in ACTIVATIONS:
            raise ValueError(unknown("activation", str(activation), ACTIVATIONS))
        activation = ACTIVATIONS[match[1]]
    return {"steps": steps, "use_sde": found.get("use_sde") is True, "activation": activation}


def _tensors(data: bytes) -> dict[str, np.ndarray]:
    """The tensors of `policy.pth`; torch refuses whatever is none."""
    import torch

    try:
        found = torch.load(io.BytesIO(data), map_location="cpu", weights_only=True)
    except Exception as error:
        raise ValueError(f"{_WEIGHTS!r} holds no plain tensors: {str(error).splitlines()[0]}") from error
    if not isinstance(found, dict) or not all(isinstance(value, torch.Tensor) for value in found.values()):
        raise ValueError(f"{_WEIGHTS!r} holds no mapping of tensors")
    return {str(name): array(value) for name, value in found.items()}
