"""Keeps finished conditions on disk: each runs once, until something that decides its result changes."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from functools import cache
from pathlib import Path

import pandas as pd

import policies
from policies.evaluation.experiment import Experiment
from policies.study.conditions import Condition
from policies.study.config import Study
from slipgym.atomic_io import new_folder
from slipgym.config import files

_TOP = Path(policies.__file__).parents[1]
_SOURCES = (
    *("slipgym/**/*.py", "estimator/**/*.py", "policies/*.py", "policies/controllers/*.py"),
    *("policies/evaluation/*.py", "policies/learned/*.py"),
)
_CONFIGS = ("*.yaml", "sensors/*.yaml", "randomization/*.yaml", "levels/*.yaml")
_TABLE = "episodes.parquet"


class Store:
    """The folder of a study's conditions, which need not exist."""

    def __init__(self, path: Path, study: Study) -> None:
        self._path, self._study = path, study

    def _place(self, condition: Condition) -> Path:
        return self._path / f"{condition.name}__{fingerprint(condition, self._study)}"

    def has(self, condition: Condition) -> bool:
        """Whether a condition is finished."""
        return (self._place(condition) / _TABLE).exists()

    def read(self, condition: Condition) -> pd.DataFrame:
        """The episodes of a finished condition, a row each."""
        return pd.read_parquet(self._place(condition) / _TABLE)

    def write(self, condition: Condition, episodes: pd.DataFrame) -> None:
        """Keeps a condition, whole or not at all."""
        with new_folder(self._place(condition)) as folder:
            episodes.to_parquet(folder / _TABLE, index=False)


def fingerprint(condition: Condition, study: Study) -> str:
    """Sixteen digits that change with the experiment, the learned policy and the sources that run it."""
    path = Path(condition.policy)
    return mark(condition.experiment(study), _folder(path) if path.is_dir() else "")


def mark(experiment: Experiment, more: str) -> str:
    """Sixteen digits that change with an experiment, with something more and with the sources that run it."""
    asked = json.dumps(experiment.model_dump(mode="json"), sort_keys=True)
    return hashlib.sha256("\n".join([asked, more, sources()]).encode()).hexdigest()[:16]


@cache
def sources() -> str:
    """A digest of everything that an episode depends on: programs and configuration, not pictures."""
    paths = {path for pattern in _SOURCES for path in _TOP.glob(pattern)}
    return _digest(paths.union(*(files.folder().glob(name) for name in _CONFIGS)))


@cache
def _folder(path: Path) -> str:
    return _digest(each for each in path.rglob("*") if each.is_file())


def _digest(paths: Iterable[Path]) -> str:
    digest = hashlib.sha256()
    for path in sorted(paths):
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()
