"""From an experiment to its run folder."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from policies.evaluation.experiment import Experiment
from policies.evaluation.folder import run_path, write_origin
from policies.evaluation.plan import plan
from policies.evaluation.plots import draw
from policies.evaluation.tables import markdown, summarise
from policies.evaluation.trial import Result, run_trials
from slipgym.atomic_io import new_folder


def evaluate(
    experiment: Experiment,
    output: str | os.PathLike[str] = "runs",
    jobs: int = 1,
    progress: bool = True,
) -> Path:
    """Runs an experiment and writes its tables and figures.

    Args:
        experiment: From `load_experiment`.
        output: Folder that the run's own folder goes to.
        jobs: Processes; -1 for one per core. The results do not depend on it.
        progress: Whether to show a progress bar.

    Returns:
        The run's folder, which appears only when it is complete.

    Raises:
        ValueError: A policy refuses its parameters or the observations.
        OSError: The output cannot be written.
    """
    path = run_path(experiment, output)
    with new_folder(path) as folder:
        write_origin(experiment, folder)
        write_results(experiment, run_trials(experiment, plan(experiment), jobs, progress), folder)
    return path


def write_results(experiment: Experiment, results: Sequence[Result], folder: Path) -> None:
    """Writes the table of trials, the series of the first trials, the summary and the figures."""
    trials = pd.DataFrame([result.row for result in results])
    series = pd.concat(
        [
            pd.DataFrame({"row": row, **result.series})
            for row, result in enumerate(results)
            if result.series is not None
        ],
        ignore_index=True,
    )
    summary = summarise(trials, experiment.task)
    trials.to_parquet(folder / "trials.parquet")
    trials.to_csv(folder / "trials.csv", index=False)
    series.to_parquet(folder / "series.parquet")
    summary.to_csv(folder / "summary.csv", index=False)
    page = markdown(summary, experiment.task, len(trials))
    (folder / "summary.md").write_text(page, encoding="utf-8")
    draw(experiment.task, trials, series, folder)
