"""The hand-over of a trained policy. Nothing else knows what a policy file looks like."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from policies.training.config import Training


def write(model: Any, normalisation: Mapping[str, Any], config: Training, folder: Path) -> None:
    """TO BE WIRED to `policies.learned.export`; until then a run keeps its checkpoints and nothing more.

    Args:
        model: The learner with the best parameters of the run.
        normalisation: Statistics to normalise observations with, as from `model.normalisation`.
        config: What it was trained as.
        folder: The run's folder.
    """
