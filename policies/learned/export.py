"""Between Stable-Baselines3's models and the files of policies. Needs the extra `train`."""

from __future__ import annotations

import importlib
import os
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from policies.learned import files
from policies.learned.description import TRAINING, WEIGHTS, Description, Environment
from policies.learned.extract import ALGORITHMS, acting_tensors, algorithm_of, array, critic_of, network_of
from policies.learned.fitting import column_of
from policies.versions import versions
from slipgym.config.load import content, randomization_content
from slipgym.config.yaml_model import file_content


def save(
    model: Any,
    path: str | os.PathLike[str],
    environment: str,
    arguments: Mapping[str, Any],
    normalisation: Any = None,
    command: str = "",
    seeds: Sequence[int] = (),
    training: bool = True,
) -> Path:
    """Writes a model as a policy's folder, whole or not at all.

    Args:
        model: PPO, SAC, TQC or RecurrentPPO with an "MlpPolicy" on observations that are vectors.
        path: Where the folder shall appear.
        environment: Id of the environment it was trained in, such as "slipgym/LinearSlip-v0".
        arguments: Keyword arguments of that environment.
        normalisation: The `VecNormalize` whose observations it was trained on; None without one.
        command: What trained it, for the record.
        seeds: Of the training, for the record.
        training: Whether to keep all that training adapts, so that `build` can go on from it.

    Raises:
        FileExistsError: Something is there already.
        ValueError: The model is of a kind that the format does not hold, or not of this environment.
    """
    algorithm, network, where = algorithm_of(model), network_of(model), described(environment, arguments)
    acts, reads = len(where["action"]), (where["history"] + 1) * len(where["observation"])
    for what, space, shape in (
        ("observation", model.observation_space, (reads,)),
        ("action", model.action_space, (acts,)),
    ):
        if space.shape != shape:
            raise ValueError(f"the model's {what} has shape {space.shape}, that of {environment} {shape}")
    critic = critic_of(model).model_dump(mode="json") if training else None
    weights, normalised = acting_tensors(model), None
    kept = {f"policy.{name}": array(tensor) for name, tensor in model.policy.state_dict().items()}
    if getattr(model, "log_ent_coef", None) is not None:
        kept["log_ent_coef"] = array(model.log_ent_coef)
    if normalisation is not None:
        kept |= _moments("reward", normalisation.ret_rms)
        if normalisation.norm_obs:
            normalised = {"clip": float(normalisation.clip_obs), "epsilon": float(normalisation.epsilon)}
            moments = _moments("observation", normalisation.obs_rms)
            kept["observation.count"] = moments.pop("observation.count")
            weights |= moments
    description = {
        "environment": where,
        "network": network.model_dump(mode="json"),
        "normalisation": normalised,
        "origin": origin(algorithm, command, model.num_timesteps, seeds, critic=critic),
    }
    return files.write(path, description, weights, kept if training else None)


def build(path: str | os.PathLike[str], env: Any, **hyperparameters: Any) -> Any:
    """Rebuilds the model that a policy was saved from, for more training.

    Networks, critics and, in SAC and TQC, the tuned entropy coefficient are those saved, in the folder's
    `training.safetensors`; optimisers start afresh. Hyperparameters are those of the algorithm's class.
    Observations that were normalised must be so again: see `normaliser`.

    Raises:
        ValueError: The folder is no policy, or its tensors are not exactly the model's.
    """
    import torch

    description, kept = files.read(path, TRAINING)
    _, weights = files.read(path, WEIGHTS)
    name, source = description.origin.algorithm, Path(path) / TRAINING
    algorithm = getattr(importlib.import_module(ALGORITHMS[name]), name)
    policy = "MlpLstmPolicy" if description.network.memory else "MlpPolicy"
    if kept.get("policy.log_std", np.zeros(1)).ndim == 2:  # a deviation for each unit, not for each action
        hyperparameters = {"use_sde": True, **hyperparameters}
    model = algorithm(policy, env, policy_kwargs=_policy_arguments(description), **hyperparameters)
    tensors = {key: torch.tensor(value) for key, value in kept.items()}
    state = {key[7:]: value for key, value in tensors.items() if key.startswith("policy.")}
    try:
        model.policy.load_state_dict(state, strict=True)
    except RuntimeError as error:
        raise ValueError(f"{source}: {error}") from error
    for key, value in acting_tensors(model).items():
        if not np.array_equal(value, weights[key]):
            raise ValueError(f"{source}: {key!r} is not the one of {WEIGHTS}")
    if "log_ent_coef" in tensors and getattr(model, "log_ent_coef", None) is not None:
        model.log_ent_coef.data[:] = tensors["log_ent_coef"]
    return model


def normaliser(path: str | os.PathLike[str], env: Any, **options: Any) -> Any:
    """A `VecNormalize` around a `VecEnv` that goes on where that of the training ended.

    The folder needs its `training.safetensors`; options are further arguments of `VecNormalize`.

    Raises:
        ValueError: The folder is no policy, or was trained without.
    """
    from stable_baselines3.common.vec_env import VecNormalize

    description, kept = files.read(path, TRAINING)
    _, weights = files.read(path, WEIGHTS)
    if "reward.count" not in kept:
        raise ValueError(f"{os.fspath(path)} was trained without VecNormalize")
    observed, tensors = description.normalisation, {**kept, **weights}
    if observed is not None:
        options = {"clip_obs": observed.clip, "epsilon": observed.epsilon, **options}
    wrapped: Any = VecNormalize(env, norm_obs=observed is not None, **options)
    for name, attribute in (("observation", "obs_rms"), ("reward", "ret_rms")):
        if f"{name}.count" in kept:
            moments = getattr(wrapped, attribute)
            moments.mean, moments.var = (tensors[f"{name}.{part}"].copy() for part in ("mean", "var"))
            moments.count = float(tensors[f"{name}.count"])
    return wrapped


def described(environment: str, arguments: Mapping[str, Any]) -> dict[str, Any]:
    """Description of an environment in policy.json.

    Raises:
        ValueError: The id or an argument is not allowed.
    """
    engine = {} if find_spec("pybullet") else {"engine": "planar"}  # the columns are the same
    # a policy's file names no other files
    readers = {"config": content, "randomization": randomization_content, "level": file_content}
    arguments = {
        name: readers[name](value) if name in readers else value for name, value in arguments.items()
    }
    given = {"disable_env_checker": True, **engine, **arguments}
    env: Any = gym.make(f"slipgym:{environment}", **given).unwrapped
    with env:
        values = {
            "id": environment,
            "arguments": arguments,
            "rate": float(env.metadata["render_fps"]),
            "history": int(arguments.get("history", 0)),
            "observation": [column_of(column) for column in env.columns],
            "action": [column_of(column) for column in env.action_columns],
        }
    return Environment.model_validate(values).model_dump(mode="json")


def origin(algorithm: str, command: str, steps: int, seeds: Sequence[int], **more: Any) -> dict[str, Any]:
    """Origin of a policy in policy.json, with the present versions; see `description.Origin`."""
    return {
        "algorithm": algorithm,
        "command": command,
        "steps": int(steps),
        "seeds": list(seeds),
        "versions": versions(),
        **more,
    }


def _moments(name: str, moments: Any) -> dict[str, np.ndarray]:
    return {
        f"{name}.{part}": np.asarray(getattr(moments, part), np.float64) for part in ("mean", "var", "count")
    }


def _policy_arguments(description: Description) -> dict[str, Any]:
    """`policy_kwargs` of the model."""
    from torch import nn

    network, critic = description.network, description.origin.critic
    assert critic is not None
    off_policy = description.origin.algorithm in ("SAC", "TQC")
    activation = {"tanh": nn.Tanh, "relu": nn.ReLU, "elu": nn.ELU}[network.activation]
    arches = {"pi": list(network.layers), "qf" if off_policy else "vf": list(critic.layers)}
    arguments: dict[str, Any] = {"activation_fn": activation, "net_arch": arches}
    if off_policy:
        arguments["n_critics"] = critic.count
    if description.origin.algorithm == "TQC":
        arguments["n_quantiles"] = critic.quantiles
    if network.memory is not None:
        arguments |= {"lstm_hidden_size": network.memory.size, "n_lstm_layers": network.memory.layers}
        arguments |= {"shared_lstm": critic.memory == "shared", "enable_critic_lstm": critic.memory == "own"}
    return arguments
