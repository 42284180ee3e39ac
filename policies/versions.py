"""Lists the versions of the packages that results depend on."""

from __future__ import annotations

import importlib.metadata
import json
import platform
from pathlib import Path

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
