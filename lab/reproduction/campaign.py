"""From recorded trials to a run folder with the paper's table."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import joblib
import pandas as pd
import yaml
from tqdm import tqdm

from lab.reproduction.mechanism import summary
from lab.reproduction.records import Record
from lab.reproduction.rerun import explorations, rows, variants
from lab.reproduction.table_plot import plot_table
from lab.reproduction.tables import markdown, mechanism_markdown, nine_columns
from lab.reproduction.trial_plots import plot_slip, plot_trial
from policies.evaluation.frames import distinct
from policies.evaluation.plots.style import STYLE, styled
from policies.versions import stamped, write_versions
from slipgym.atomic_io import new_folder
from slipgym.config import load


@dataclass(frozen=True)
class Campaign:
    """An experiment of the paper."""

    name: str
    """Its key in `published.TABLES`."""
    record: Callable[..., Record]
    """(scenario, **settings) -> its record."""
    settings: Mapping[str, Any]
    """What holds for all trials; with "contact"."""
    seed: int
    """What the trials' seeds were made from."""
    exploration: Mapping[str, Any] | None = None
    """Keys of the trials that serve as an exploration before others of the same material."""


def reproduce(
    campaign: Campaign,
    scenarios: Sequence[Mapping[str, Any]],
    example: Mapping[str, Any],
    output: str | os.PathLike[str],
    jobs: int,
    progress: bool,
) -> Path:
    """Records all trials, runs every estimator on the records and writes tables and figures.

    Args:
        campaign: The experiment.
        scenarios: One per trial.
        example: Keys of the trial that the figures show; the first that has them.
        output: Folder that the run's own folder goes to.
        jobs: Processes; -1 for one per core.
        progress: Whether to show progress bars.

    Returns:
        The run's folder.

    Raises:
        ValueError: There are no trials.
    """
    if not scenarios:
        raise ValueError("trials must be at least 1")
    records = record_all(campaign, scenarios, jobs, progress)
    explore = campaign.exploration
    before = [None] * len(records) if explore is None else explorations(records, explore)
    listed = tqdm(variants(explore is not None), desc="estimators", unit="estimator", disable=not progress)
    trials = pd.DataFrame(
        [
            row
            for one in listed
            for pair in zip(records, before, strict=True)
            for row in rows(pair[0], one, pair[1])
        ]
    )
    path = stamped(output, f"{campaign.name}__{campaign.seed}")
    with new_folder(path) as folder:
        write_origin(campaign, folder)
        trials.to_csv(folder / "trials.csv", index=False)
        write_summaries(campaign.name, trials, records, folder)
        shown = next(r for r in records if example.items() <= r.keys.items())
        with styled():
            for name, figure in {
                "trial": plot_trial(shown),
                "slip": plot_slip(shown),
                "table": plot_table(nine_columns(trials), campaign.name),
            }.items():
                figure.savefig(folder / f"{name}.png", dpi=STYLE.dpi)
    return path


def write_origin(campaign: Campaign, folder: Path) -> None:
    """Writes where results come from: settings and seed, the worlds' configuration, the versions."""
    documents = {
        "settings": {**campaign.settings, "seed": campaign.seed},
        "environment": load(contact=campaign.settings["contact"]).model_dump(mode="json"),
    }
    for name, values in documents.items():
        (folder / f"{name}.yaml").write_text(yaml.safe_dump(values, sort_keys=False), encoding="utf-8")
    write_versions(folder)


def record_all(
    campaign: Campaign, scenarios: Sequence[Mapping[str, Any]], jobs: int, progress: bool
) -> list[Record]:
    """The records of all trials, in order, whatever the number of processes."""
    parallel = joblib.Parallel(n_jobs=jobs, return_as="generator")
    found: Any = parallel(joblib.delayed(campaign.record)(s, **campaign.settings) for s in scenarios)
    return list(tqdm(found, total=len(scenarios), desc=campaign.name, unit="trial", disable=not progress))


def write_summaries(name: str, trials: pd.DataFrame, records: Sequence[Record], folder: Path) -> None:
    """Writes the paper's table, and what the samples called moving are made of."""
    table = nine_columns(trials)
    by_material = {m: [r for r in records if r.keys["material"] == m] for m in distinct(table, "material")}
    samples = pd.DataFrame([{"material": m, **summary(group)} for m, group in by_material.items()])
    table.to_csv(folder / "table.csv", index=False)
    samples.to_csv(folder / "samples.csv", index=False)
    dropped = sum(record.dropped for record in records)
    page = [
        f"# {name}: {len(records)} trials, {dropped} dropped",
        markdown(table, name),
        "## Samples called moving",
        mechanism_markdown(samples),
    ]
    (folder / "table.md").write_text("\n\n".join(page) + "\n", encoding="utf-8")
