"""The folder of a run: it appears when it is complete, or not at all."""

from __future__ import annotations

import importlib.metadata
import json
import os
import platform
from datetime import datetime
from pathlib import Path

import yaml

from policies.atomic_io import filled_in_place as filled_in_place
from policies.evaluation.experiment import Experiment

_PACKAGES = (
    "slipgym",
    "gymnasium",
    "joblib",
    "matplotlib",
    "numba",
    "numpy",
    "pandas",
    "pyarrow",
    "pybullet",
    "pydantic",
    "scipy",
)


def run_path(experiment: Experiment, output: str | os.PathLike[str]) -> Path:
    """Where a run that starts now goes: <output>/<experiment>__<seed>__<timestamp>."""
    return stamped(output, f"{experiment.name}__{experiment.seed}")


def stamped(output: str | os.PathLike[str], name: str) -> Path:
    """A folder's path that says what it holds and when it was begun: <output>/<name>__<timestamp>."""
    stamp = datetime.now().strftime("%Y%m%d-%H%M%S-%f")[:-3]
    return Path(output).expanduser().resolve() / f"{name}__{stamp}"


def write_origin(experiment: Experiment, folder: Path) -> None:
    """Writes where results come from: the experiment, the environment's configuration, the versions."""
    documents = {"experiment": experiment, "environment": experiment.environment_config()}
    for name, model in documents.items():
        text = yaml.safe_dump(model.model_dump(mode="json"), sort_keys=False, allow_unicode=True)
        (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    write_versions(folder)


def write_versions(folder: Path) -> None:
    """Writes versions.json: what the results were made with."""
    (folder / "versions.json").write_text(json.dumps(versions(), indent=2) + "\n", encoding="utf-8")


def versions() -> dict[str, str | None]:
    """Versions of Python, the platform and the packages; None for one that is not installed."""
    found: dict[str, str | None] = {"python": platform.python_version(), "platform": platform.platform()}
    for package in _PACKAGES:
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            found[package] = None
    return found
