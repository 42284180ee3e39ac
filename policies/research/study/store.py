"""Finished cells on disk: a cell is run once, as long as nothing that decides its result changes."""

from __future__ import annotations

import hashlib
import json
from functools import cache
from pathlib import Path

import pandas as pd

import policies
from policies.research.study.cells import Cell
from policies.research.study.config import Study
from slipgym.atomic_io import new_folder
from slipgym.config import files

_TOP = Path(policies.__file__).parents[1]
_SOURCES = (
    "slipgym/**/*.py",
    "estimator/**/*.py",
    "policies/*.py",
    "policies/evaluation/*.py",
    "policies/learned/*.py",
)
_CONFIGS = ("*.yaml", "sensors/*.yaml", "randomization/*.yaml")
_TABLE = "episodes.parquet"


class Store:
    """The folder of a study's cells.

    Args:
        path: The folder; need not exist.
        study: The study.
    """

    def __init__(self, path: Path, study: Study) -> None:
        self._path, self._study = path, study

    def _place(self, cell: Cell) -> Path:
        return self._path / f"{cell.name}__{fingerprint(cell, self._study)}"

    def has(self, cell: Cell) -> bool:
        """Whether a cell is finished."""
        return (self._place(cell) / _TABLE).exists()

    def read(self, cell: Cell) -> pd.DataFrame:
        """The episodes of a finished cell, a row each."""
        return pd.read_parquet(self._place(cell) / _TABLE)

    def write(self, cell: Cell, episodes: pd.DataFrame) -> None:
        """Keeps a cell, whole or not at all."""
        with new_folder(self._place(cell)) as folder:
            episodes.to_parquet(folder / _TABLE, index=False)


def fingerprint(cell: Cell, study: Study) -> str:
    """Sixteen digits that change with the experiment, the learned policy and the sources that run it."""
    told = json.dumps(cell.experiment(study).model_dump(mode="json"), sort_keys=True)
    parts = [told, _folder(Path(cell.policy)) if Path(cell.policy).is_dir() else "", sources()]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


@cache
def sources() -> str:
    """A digest of everything that an episode depends on: programs and configuration, not pictures."""
    paths = [path for pattern in _SOURCES for path in _TOP.glob(pattern)]
    paths += [path for name in _CONFIGS for path in files.folder().glob(name)]
    return _digest(paths)


@cache
def _folder(path: Path) -> str:
    return _digest([each for each in path.rglob("*") if each.is_file()])


def _digest(paths: list[Path]) -> str:
    digest = hashlib.sha256()
    for path in sorted(set(paths)):
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()
