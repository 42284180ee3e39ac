"""Writes the policy of a finished training run."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stable_baselines3.common.vec_env import VecNormalize

from policies.learned import export, files
from policies.training import derived, policy_tensors
from policies.training import model as learners
from policies.training.config import Training
from slipgym.tasks import find

POLICY = "policy"
"""Name of the policy in the run's folder."""


def write(
    model: Any, normalisation: Mapping[str, Any], config: Training, folder: Path, seed: int, command: str
) -> Path:
    """Writes the policy of a run (docs/policy_files.md) in its folder, unless it is there already."""
    path = folder / POLICY
    if path.exists():
        return path
    arguments = config.environment.model_dump(mode="json")
    env_id = find(config.task).id
    if config.algorithm != "privileged_ppo":
        envs = model.get_vec_normalize_env()
        learners.set_normalisation(envs, dict(normalisation))
        if config.derived:
            model, envs = _folded(model, envs, config)
        return export.save(model, path, env_id, arguments, envs, command, [seed])
    clip = config.normalisation.clip
    moments = model.moments["policy"] if config.normalisation.observation else None
    description = {
        "environment": export.described(env_id, arguments),
        "network": policy_tensors.network(config).model_dump(mode="json"),
        "normalisation": moments and {"clip": clip, "epsilon": policy_tensors.EPSILON},
        "origin": export.origin("PrivilegedPPO", command, model.num_timesteps, [seed]),
    }
    return files.write(path, description, policy_tensors.take(model.ppo.actor, moments, model.matrix))


def _folded(model: Any, envs: VecNormalize, config: Training) -> tuple[Any, VecNormalize]:
    """A learner without derived columns that acts as one with them, and its environments."""
    plain = config.model_copy(update={"derived": {}, "num_envs": 1})
    found: Any = envs.venv
    own = learners.normalised(plain, found.venv)
    count = found.matrix.shape[1]
    own.ret_rms = envs.ret_rms
    if own.norm_obs:
        read: Any = envs.obs_rms
        moments: Any = own.obs_rms
        moments.mean, moments.var, moments.count = read.mean[:count], read.var[:count], read.count
    learner = learners.make(plain, own, 0)
    learner.policy.load_state_dict(derived.fold(model.policy.state_dict(), envs, found.matrix))
    learner.num_timesteps = model.num_timesteps
    return learner, own
