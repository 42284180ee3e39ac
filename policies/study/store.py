"""Runs conditions and keeps them on disk: each once, until something that decides its result changes."""

from __future__ import annotations

import hashlib
import importlib
import json
from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import pandas as pd
from tqdm import tqdm

import policies
from estimator.reference import is_reference
from policies import parallel
from policies.evaluation.experiment import Experiment
from policies.evaluation.plan import pieces, plan
from policies.evaluation.trial import run_block
from policies.study.conditions import Condition
from policies.study.config import Study
from slipgym.atomic_io import new_folder
from slipgym.config import files

_TOP = Path(policies.__file__).parents[1]
_SOURCES = (
    *("slipgym/**/*.py", "estimator/**/*.py", "policies/*.py", "policies/controllers/*.py"),
    *("policies/evaluation/*.py", "policies/learned/*.py", "policies/policy_leaderboard/*.py"),
)
_CONFIGS = ("*.yaml", "sensors/*.yaml", "randomization/*.yaml", "levels/*.yaml")


class Store:
    """The folder of a study's conditions, which need not exist."""

    def __init__(self, path: Path, study: Study) -> None:
        self._path, self._study = path, study

    def table(self, condition: Condition) -> Path:
        """The file of a condition's episodes, a row each; it exists if the condition is finished."""
        return self._path / f"{condition.name}__{fingerprint(condition, self._study)}" / "episodes.parquet"

    def write(self, condition: Condition, rows: pd.DataFrame) -> None:
        """Keeps a condition, whole or not at all; another process may have kept the same before."""
        with suppress(FileExistsError), new_folder(self.table(condition).parent) as folder:
            rows.to_parquet(folder / self.table(condition).name, index=False)

    def read(self, condition: Condition) -> pd.DataFrame:
        """The episodes of a finished condition.

        Raises:
            ValueError: The file is damaged.
        """
        path = self.table(condition)
        try:
            return pd.read_parquet(path)
        except (OSError, ValueError) as error:  # ValueError: pyarrow's
            raise ValueError(f"{path}: {error}; delete its folder, and the condition is run again") from error


def fingerprint(condition: Condition, study: Study) -> str:
    """Sixteen digits that change with the experiment, the learned policy and the sources that run it."""
    path = Path(condition.policy)
    return mark(condition.experiment(study), _folder(path) if path.is_dir() else "")


def mark(experiment: Experiment, more: str) -> str:
    """Sixteen digits that change with an experiment, with something more and with the sources that run it.

    Of a module that it names, the content counts; not what that module imports.
    """
    asked = json.dumps(experiment.model_dump(mode="json"), sort_keys=True)
    return hashlib.sha256("\n".join([asked, more, sources(), _modules(experiment)]).encode()).hexdigest()[:16]


def _modules(experiment: Experiment) -> str:
    """A digest of the modules of the experiment's references, tasks of one's own for example."""
    estimators = [choice.estimator["name"] for choice in experiment.friction if choice.estimator]
    names = [experiment.task, *(policy.name for policy in experiment.policies), *estimators]
    modules = {name.partition(":")[0] for name in names if is_reference(name) and not Path(name).is_dir()}
    sources = (importlib.import_module(module).__file__ for module in modules)
    return _digest(Path(source) for source in sources if source)


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


COLUMNS = ["seed", "success", "dropped", "return", "steps", "mean_force_N", "final_mu_c", "true_mu_c"]
"""What is kept of an episode of any task, besides the keys of its condition and its number."""


def episodes(
    study: Study, conditions: Sequence[Condition], store: Store, jobs: int = 1, progress: bool = True
) -> pd.DataFrame:
    """The episodes of all conditions; those that are not in the store are run and kept there, one by one.

    The results do not depend on the number of processes, -1 for one per core.

    Raises:
        ValueError: A policy refuses the observations.
        OSError: The store cannot be written.
    """
    pending = [condition for condition in conditions if not store.table(condition).exists()]
    experiments = [condition.experiment(study) for condition in pending]
    planned = [(condition, each, plan(each)) for condition, each in zip(pending, experiments, strict=True)]
    work = [(each, piece) for _, each, trials in planned for piece in pieces(each, trials)]
    results = parallel.results(run_block, work, jobs)
    total = sum(len(trials) for _, _, trials in planned)
    with tqdm(total=total, desc=study.name, unit="episode", disable=not progress) as bar:
        for condition, _, trials in planned:
            rows: list[dict[str, Any]] = []
            while len(rows) < len(trials):
                for result in next(results):
                    kept = {name: result.row[name] for name in COLUMNS}
                    rows.append({**condition.keys, "episode": len(rows), **kept})
                    bar.update()
            store.write(condition, pd.DataFrame(rows))
    return pd.concat(map(store.read, conditions), ignore_index=True)
