"""Trains the network of "gru": makes a folder, records episodes, fits."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pandas as pd
import yaml
from tqdm import tqdm

from lab.learned_estimator.columns import Sequence, sequences
from lab.learned_estimator.config import Training
from lab.learned_estimator.episodes import record
from lab.learned_estimator.fit import Curve, fit
from lab.learned_estimator.weights import Tensors, save
from policies.versions import claimed, write_versions
from slipgym.atomic_io import new_file

WEIGHTS = "gru.npz"
"""Name of the file of weights in a run's folder."""
UNFINISHED = "unfinished.npz"
"""Name of that file while the training goes on."""
NOTE = (
    "Network of slipgym's estimator gru. Made by `slipgym train-estimator --seed {seed}` from simulated "
    "episodes of slipgym alone, {samples} samples. Licence: that of slipgym (MIT)."
)


def recorded(training: Training, seed: int, progress: bool = True) -> list[Sequence]:
    """Sequences of all combinations of tasks, friction sources and contacts.

    Args:
        training: Which.
        seed: Of the episodes, >= 0; every combination has episodes of its own.
        progress: Whether to show a progress bar.
    """
    found: list[Sequence] = []
    for k, arguments in enumerate(tqdm(training.episodes(), desc="episodes", disable=not progress)):
        own = 1_000_000 * seed + 10_000 * k
        recordings = record(
            rows=training.rows, steps=training.steps, seed=own, disturbed=training.disturbed, **arguments
        )
        found += sequences(recordings, training.unzeroed, own)
    return found


def train(
    training: Training, output: str | os.PathLike[str] = "runs", seed: int = 0, progress: bool = True
) -> Path:
    """Trains a network from the start; what is there so far is kept in the run's folder meanwhile.

    Args:
        training: How.
        output: Folder that the run's own folder goes to.
        seed: Of episodes, initial weights and order, >= 0.
        progress: Whether to show progress bars.

    Returns:
        The run's folder: gru.npz, training.yaml, curve.csv, versions. Before the end of the training
        unfinished.npz has the place of gru.npz.

    Raises:
        FloatingPointError: The loss is not finite.
        OSError: The folder cannot be written; before anything is recorded.
    """
    path, began = claimed(output, "gru"), time.monotonic()
    write_versions(path)
    settings = yaml.safe_dump(training.model_dump(mode="json"), sort_keys=False)
    (path / "training.yaml").write_text(f"# seed {seed}\n{settings}", encoding="utf-8")
    data = recorded(training, seed, progress)
    samples = sum(len(one.columns) for one in data)
    tqdm.write(f"{len(data)} recordings, {samples} samples, {time.monotonic() - began:.0f} s")

    def keep(tensors: Tensors, curve: Curve) -> None:
        with new_file(path / UNFINISHED) as file:
            save(file, tensors, NOTE.format(seed=seed, samples=samples))
        with new_file(path / "curve.csv") as file:
            pd.DataFrame(curve).to_csv(file, index=False)

    fit(training, data, seed, keep, progress)
    (path / UNFINISHED).rename(path / WEIGHTS)
    tqdm.write(f"trained in {time.monotonic() - began:.0f} s")
    return path
