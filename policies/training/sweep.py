"""A search for hyperparameters with Optuna."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import optuna
from optuna.storages import JournalStorage
from optuna.storages.journal import JournalFileBackend

from policies import parallel
from policies.training import files, folder
from policies.training.config import Dimension, Training
from policies.training.curve import Row
from policies.training.run import train
from policies.versions import claimed
from slipgym import atomic_io
from slipgym.tasks import find


def first(config: Training) -> Training:
    """The configuration with the first value of everything that a sweep of it tries.

    Raises:
        ValueError: It declares nothing to try, or a key or value is wrong.
    """
    if not config.sweep:
        raise ValueError("nothing to try: the configuration has no key sweep, a mapping of dotted keys")
    values = {key: one.choices[0] if one.choices else one.low for key, one in config.sweep.items()}
    return files.changed(config, values, "sweep")


def begin(config: Training, output: Path) -> Path:
    """Makes the folder of a sweep."""
    path = claimed(output, f"{find(config.task).key}__{config.algorithm}__sweep")
    _study(path)
    return path


def sweep(
    path: Path,
    config: Training,
    trials: int,
    seed: int = 0,
    jobs: int = 1,
    ray: str = "",
    progress: bool = True,
) -> str:
    """Trains with one choice of hyperparameters after the other, and keeps the best as best.yaml.

    The seed is that of all runs, and of the search; with several runs at once (`jobs`, `ray`: see
    `policies.parallel.results`) what is tried depends on which ends first. Returns what came out, as text.
    """
    items = [(path, config, seed, k, progress) for k in range(trials)]
    list(parallel.results(trial, items, jobs, ray))
    study = _study(path)
    found = files.changed(config, _values(study.best_params))
    atomic_io.write(path / "best.yaml", files.text(found).encode())
    return f"Look at {path}\n  best, {study.best_value:.3f}: {_values(study.best_params)}"


def trial(path: Path, config: Training, seed: int, number: int, progress: bool) -> None:
    """One run of a sweep, in a folder of its own."""
    study = _study(path, optuna.samplers.TPESampler(seed=seed + number))

    def objective(one: optuna.Trial) -> float:
        chosen = _values({key: _suggest(one, key, dimension) for key, dimension in config.sweep.items()})
        run = path / f"trial__{one.number}"
        folder.begin(run, files.changed(config, chosen, "sweep"), seed)
        train(run, progress, number)
        return area(folder.read_curve(run), config)

    study.optimize(objective, n_trials=1)


def area(rows: Sequence[Row], config: Training) -> float:
    """Mean share of episodes solved over the budget: high if it is learned early.

    After an early end of a run the last value of its curve counts for the rest.
    """
    due = max(len(rows), 1 + config.budget // config.evaluation.every)
    shares = [row.success for row in rows]
    return (sum(shares) + (due - len(rows)) * shares[-1]) / due


def _suggest(one: optuna.Trial, key: str, dimension: Dimension) -> Any:
    low, high = dimension.low, dimension.high
    if dimension.choices:
        return one.suggest_categorical(key, [json.dumps(choice) for choice in dimension.choices])
    if isinstance(low, int) and isinstance(high, int):
        return one.suggest_int(key, low, high, log=dimension.log)
    return one.suggest_float(key, low, high, log=dimension.log)  # type: ignore[arg-type]


def _values(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Choices, which Optuna keeps as text, as the values they are."""
    return {key: json.loads(value) if isinstance(value, str) else value for key, value in parameters.items()}


def _study(path: Path, sampler: Any = None) -> optuna.Study:
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    storage = JournalStorage(JournalFileBackend(str(path / folder.SWEEP)))
    return optuna.create_study(
        storage=storage, study_name="sweep", direction="maximize", sampler=sampler, load_if_exists=True
    )
