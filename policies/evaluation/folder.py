"""Names the folder of a run and writes where its results come from."""

from __future__ import annotations

import os
from datetime import datetime
from pathlib import Path

import yaml

from policies.evaluation.experiment import Experiment
from policies.versions import write_versions

INCOMPLETE = "INCOMPLETE"
"""File in the folder of a run that is not over."""


def run_path(experiment: Experiment, output: str | os.PathLike[str]) -> Path:
    """Folder of a run that starts now: <output>/<experiment>__<seed>__<timestamp>."""
    return stamped(output, f"{experiment.name}__{experiment.seed}")


def stamped(output: str | os.PathLike[str], name: str) -> Path:
    """A folder's path that says what it holds and when it was begun: <output>/<name>__<timestamp>."""
    stamp = datetime.now().strftime("%Y%m%d-%H%M%S-%f")[:-3]
    return Path(output).expanduser().resolve() / f"{name}__{stamp}"


def write_origin(experiment: Experiment, folder: Path) -> None:
    """Writes where results come from: the experiment, configuration and task settings, the versions."""
    documents = {"experiment": experiment.model_dump(mode="json"), "environment": experiment.recorded()}
    for name, values in documents.items():
        text = yaml.safe_dump(values, sort_keys=False, allow_unicode=True)
        (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    write_versions(folder)
