"""Films of the same episode under different knowledge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from policies.evaluation.frames import values, where
from policies.evaluation.plan import plan
from policies.evaluation.trial import environment, make_policy
from policies.play.watch import watch
from policies.research.study.cells import Cell
from policies.research.study.config import Study
from policies.research.study.store import fingerprint

SOURCES = ("none", "estimated", "true")


@dataclass(frozen=True)
class Film:
    """An episode on film."""

    source: str
    """What the policy is told."""
    path: Path
    success: bool
    dropped: bool


@dataclass(frozen=True)
class Scene:
    """One episode of a task, a film for each source."""

    task: str
    kind: str
    seed: int
    chosen: str
    """Why this episode, in words."""
    films: tuple[Film, ...]


def scene(
    study: Study, task: str, cells: Sequence[Cell], episodes: pd.DataFrame, folder: Path
) -> Scene | None:
    """Films a task in the world judged by; learned policies, if they have every source.

    Args:
        study: The study.
        task: The task.
        cells: All cells.
        episodes: The table of their episodes.
        folder: Where films are kept; those that are there already are not made again.

    Returns:
        The films, or None if no kind of policy has every source.
    """
    world = study.worlds[0].label
    here = [
        cell
        for cell in cells
        if (cell.world.label, cell.task, cell.preset) == (world, task, study.presets[0])
        and not cell.change.name
        and cell.estimator == study.estimators[0]
    ]
    for kind in ("learned", "classic"):
        found = {(cell.source, cell.block): cell for cell in here if cell.kind == kind}
        if {source for source, _ in found} >= set(SOURCES):
            break
    else:
        return None
    rows = where(episodes, world=world, task=task, preset=study.presets[0], kind=kind, change="")
    told = {source: _told(rows, source, study.estimators[0]) for source in SOURCES}
    number, chosen = _choose(told["none"], told["estimated"])
    films = []
    for source in SOURCES:
        row = told[source].iloc[number]
        cell = found[source, int(row["block"])]
        path = folder / f"{cell.name}__{fingerprint(cell, study)}__{row['seed']}.mp4"
        if not path.exists():
            _film(study, cell, int(row["episode"]), path)
        films.append(Film(source, path, bool(row["success"]), bool(row["dropped"])))
    return Scene(task, kind, int(told["none"]["seed"].iloc[number]), chosen, tuple(films))


def _told(rows: pd.DataFrame, source: str, estimator: str) -> pd.DataFrame:
    return where(rows, source=source, estimator=estimator if source == "estimated" else "")


def _choose(none: pd.DataFrame, estimated: pd.DataFrame) -> tuple[int, str]:
    """The first episode that shows a difference, else the first of all."""
    fails, solves = ~values(none, "success"), values(estimated, "success")
    if (fails & solves).any():
        return int(
            np.argmax(fails & solves)
        ), "the first that is lost without the estimate and solved with it"
    return 0, "the first of all, as the estimate saves no episode that is lost without it"


def _film(study: Study, cell: Cell, number: int, path: Path) -> None:
    experiment = cell.experiment(study)
    trial = plan(experiment)[number]
    watch(
        cell.task,
        make_policy(experiment, trial),
        path,
        seed=trial.seed,
        speed=study.video_speed,
        options=trial.options,
        progress=False,
        **environment(experiment, trial),
    )
