"""Writes the policy of a finished training run."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from policies.learned import export
from policies.training import model as learners
from policies.training.config import Training
from slipgym.tasks import find

POLICY = "policy"
"""Name of the policy in the run's folder."""


def write(
    model: Any, normalisation: Mapping[str, Any], config: Training, folder: Path, seed: int, command: str
) -> Path:
    """Writes the policy of a run (docs/policy_files.md), unless it is there already.

    Args:
        model: The learner with the best parameters of the run.
        normalisation: Statistics to normalise observations with, as from `model.normalisation`.
        config: What it was trained as.
        folder: The run's folder.
        seed: Of the run.
        command: What started it, for the record.

    Returns:
        The policy's folder.
    """
    path = folder / POLICY
    if path.exists():
        return path
    envs = model.get_vec_normalize_env()
    learners.set_normalisation(envs, dict(normalisation))
    arguments = config.environment.model_dump(mode="json")
    env_id = find(config.task).id
    return export.save(model, path, env_id, arguments, envs, command, [seed], residual=config.residual)
