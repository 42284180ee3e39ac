"""Makes videos of the same episode with different friction information."""

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
from policies.study.conditions import Condition
from policies.study.config import Study
from policies.study.store import fingerprint

SOURCES = ("none", "estimated", "true")


@dataclass(frozen=True)
class Clip:
    """A video of an episode."""

    source: str
    """Friction information of the policy."""
    path: Path
    success: bool
    dropped: bool


@dataclass(frozen=True)
class Scene:
    """One episode of a task, a video for each source."""

    task: str
    kind: str
    seed: int
    chosen: str
    """Why this episode, in words."""
    clips: tuple[Clip, ...]


def scene(
    study: Study, task: str, conditions: Sequence[Condition], episodes: pd.DataFrame, folder: Path
) -> Scene | None:
    """Makes videos of a task in the first world; learned policies, if they have every source.

    Args:
        study: The study.
        task: The task.
        conditions: All conditions.
        episodes: The table of their episodes.
        folder: Where clips are kept; those that are there already are not made again.

    Returns:
        The clips, or None if no kind of policy has every source.
    """
    world = study.worlds[0].label
    here = [
        condition
        for condition in conditions
        if (condition.world.label, condition.task, condition.preset) == (world, task, study.presets[0])
        and not condition.change.name
        and condition.estimator == study.estimators[0]
    ]
    for kind in ("learned", "classic"):
        found = {
            (condition.source, condition.block): condition for condition in here if condition.kind == kind
        }
        if {source for source, _ in found} >= set(SOURCES):
            break
    else:
        return None
    rows = where(episodes, world=world, task=task, preset=study.presets[0], kind=kind, change="")
    parts = {source: _of_source(rows, source, study.estimators[0]) for source in SOURCES}
    number, chosen = _choose(parts["none"], parts["estimated"])
    clips = []
    for source in SOURCES:
        row = parts[source].iloc[number]
        condition = found[source, int(row["block"])]
        path = folder / f"{condition.name}__{fingerprint(condition, study)}__{row['seed']}.mp4"
        if not path.exists():
            _write_clip(study, condition, int(row["episode"]), path)
        clips.append(Clip(source, path, bool(row["success"]), bool(row["dropped"])))
    return Scene(task, kind, int(parts["none"]["seed"].iloc[number]), chosen, tuple(clips))


def _of_source(rows: pd.DataFrame, source: str, estimator: str) -> pd.DataFrame:
    return where(rows, source=source, estimator=estimator if source == "estimated" else "")


def _choose(none: pd.DataFrame, estimated: pd.DataFrame) -> tuple[int, str]:
    """The first episode that shows a difference, else the first of all."""
    fails, solves = ~values(none, "success"), values(estimated, "success")
    if (fails & solves).any():
        return int(
            np.argmax(fails & solves)
        ), "the first that is lost without the estimate and solved with it"
    return 0, "the first of all, as the estimate saves no episode that is lost without it"


def _write_clip(study: Study, condition: Condition, number: int, path: Path) -> None:
    experiment = condition.experiment(study)
    trial = plan(experiment)[number]
    watch(
        condition.task,
        make_policy(experiment, trial),
        path,
        seed=trial.seed,
        speed=study.video_speed,
        options=trial.options,
        progress=False,
        **environment(experiment, trial),
    )
