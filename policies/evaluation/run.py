"""From an experiment to its run folder."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from policies.evaluation.experiment import Experiment
from policies.evaluation.frames import markdown as grid
from policies.evaluation.gain import compare
from policies.evaluation.plan import plan
from policies.evaluation.plots import draw, draw_gain
from policies.evaluation.tables import claims, markdown, summarise
from policies.evaluation.trial import Result, recordings, run_trials
from policies.versions import INCOMPLETE, stamped, write_origin
from slipgym.atomic_io import check_folder, new_files, new_folder

TRIALS = "trials.parquet"
"""Table of the trials."""


def evaluate(
    experiment: Experiment,
    output: str | os.PathLike[str] = "runs",
    jobs: int = 1,
    progress: bool = True,
    ray: str = "",
) -> Path:
    """Runs an experiment and writes its tables and figures.

    Args:
        experiment: From `load_experiment`.
        output: Folder that the run's own folder goes to.
        jobs: Processes; -1 for one per core. The results do not depend on it.
        progress: Whether to show a progress bar.
        ray: See `policies.parallel.results`.

    Returns:
        The run's folder. Until the run is over it holds the trials of the cells that are complete, and the
        file `INCOMPLETE`; if it ends before the first of them, nothing is left.

    Raises:
        ValueError: A policy refuses its parameters or the observations.
        OSError: The output cannot be written, which is found out before any trial.
        ModuleNotFoundError, ConnectionError: See `policies.parallel.results`.
    """
    path, trials = stamped(output, f"{experiment.name}__{experiment.seed}"), plan(experiment)
    check_folder(path.parent)

    def incomplete(finished: int, folder: Path) -> None:
        words = (
            f"{finished} of {len(trials)} trials are in the tables; summary and figures come at the end.\n"
        )
        (folder / INCOMPLETE).write_text(words, encoding="utf-8")

    with new_folder(path) as folder:
        write_origin(folder, experiment=experiment.model_dump(mode="json"), environment=experiment.recorded())
        incomplete(0, folder)

    def keep(results: Sequence[Result]) -> None:
        with new_files(path) as folder:
            write_trials(results, folder)
            incomplete(len(results), folder)

    try:
        results = run_trials(experiment, trials, jobs, progress, keep, ray)
        with new_files(path) as folder:
            write_results(experiment, results, folder)
    except BaseException as error:
        if (path / TRIALS).exists():
            error.add_note(f"the trials that are finished are in {path}")
        else:
            shutil.rmtree(path)
        raise
    (path / INCOMPLETE).unlink()
    return path


def write_results(experiment: Experiment, results: Sequence[Result], folder: Path) -> None:
    """Writes the table of trials, the series of the first trials, the summary and the figures."""
    trials, series = write_trials(results, folder)
    summary = summarise(trials, experiment.task)
    summary.to_csv(folder / "summary.csv", index=False)
    page = markdown(summary, experiment.task, len(trials), claims(trials, "## {}", grid))
    (folder / "summary.md").write_text(page, encoding="utf-8")
    draw(experiment.task, trials, series, folder)
    if (gain := compare(trials)) is not None:
        run = plan(experiment)
        chosen = [run[entry.rows[gain.episode()]] for entry in gain.entries]
        again = [recordings(experiment, [trial])[0].series() for trial in chosen]
        draw_gain(experiment.task, trials, gain, again, folder)


def write_trials(results: Sequence[Result], folder: Path) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Writes the table of trials and the series of the first trials, and returns both."""
    trials = pd.DataFrame([result.row for result in results])
    kept = ((row, result.series) for row, result in enumerate(results) if result.series is not None)
    series = pd.concat([pd.DataFrame({"row": row, **steps}) for row, steps in kept], ignore_index=True)
    trials.to_parquet(folder / TRIALS)
    trials.to_csv(folder / "trials.csv", index=False)
    series.to_parquet(folder / "series.parquet")
    return trials, series
