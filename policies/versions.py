"""Names the folder of a run and writes where its results come from, such as the versions of packages."""

from __future__ import annotations

import importlib.metadata
import json
import os
import platform
from datetime import datetime
from pathlib import Path
from typing import Any

import yaml

from slipgym import atomic_io

PACKAGES = (
    *("slipgym", "gymnasium", "numpy", "numba", "pybullet", "pydantic", "scipy"),
    *("joblib", "matplotlib", "pandas", "pyarrow"),
    *("torch", "stable-baselines3", "sb3-contrib", "rsl-rl-lib", "optuna"),
)
"""Packages of the base installation, of evaluation and of training."""


def versions() -> dict[str, str | None]:
    """Versions of Python, the platform and `PACKAGES`; None for a package that is not installed."""
    found: dict[str, str | None] = {"python": platform.python_version(), "platform": platform.platform()}
    for package in PACKAGES:
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            found[package] = None
    return found


def write_versions(folder: Path) -> None:
    """Writes `versions()` to versions.json in a folder."""
    atomic_io.write(folder / "versions.json", (json.dumps(versions(), indent=2) + "\n").encode())


INCOMPLETE = "INCOMPLETE"
"""File in the folder of a run that is not over."""


def stamped(output: str | os.PathLike[str], name: str) -> Path:
    """A folder's path that says what it holds and when it was begun: <output>/<name>__<timestamp>."""
    stamp = datetime.now().strftime("%Y%m%d-%H%M%S-%f")[:-3]
    return Path(output).expanduser().resolve() / f"{name}__{stamp}"


def claimed(output: str | os.PathLike[str], name: str) -> Path:
    """Makes such a folder, which no process that began in the same millisecond has made."""
    while True:
        path = stamped(output, name)
        try:
            path.mkdir(parents=True)
        except FileExistsError:
            continue
        return path


def write_origin(folder: Path, **documents: Any) -> None:
    """Writes plain values as YAML files of these names, such as the experiment, and the versions."""
    for name, values in documents.items():
        text = yaml.safe_dump(values, sort_keys=False, allow_unicode=True)
        atomic_io.write(folder / f"{name}.yaml", text.encode())
    write_versions(folder)
