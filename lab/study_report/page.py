"""The report of a study: one HTML file that needs nothing else."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import jinja2
import pandas as pd
import yaml
from tqdm import tqdm

from lab.frames import without
from lab.study_report.degradation import plot_degradation
from lab.study_report.differences import TRANSFER_MOST, plot_shares, plot_transfer
from lab.study_report.formats import FILTERS
from lab.study_report.inline import inline
from lab.study_report.sentences import answers
from lab.study_report.success import plot_estimators, plot_success
from lab.study_report.videos import Scene, scene
from policies.evaluation.frames import distinct, groups, records, where
from policies.evaluation.plots.style import styled
from policies.study import load_study, tables
from policies.study.conditions import conditions, missing, policies_of
from policies.study.config import Study
from policies.study.store import sources
from policies.study.tables import ALL, benefits
from policies.versions import versions
from slipgym import atomic_io

TITLES = {
    "classic": "The controllers",
    "memory": "The controllers with a memory of slips",
    "recurrent": "The recurrent networks",
    "learned": "The learned policies",
    "imitation": "The imitations",
}
"""What the report calls the kinds of policies."""
_TEMPLATE = Path(__file__).parent / "report.html.j2"


def write_report(folder: Path, command: str = "", progress: bool = True) -> Path:
    """Writes report.html into the folder of a finished study, whole.

    Args:
        folder: From `policies.study.run_study`; videos are kept in its "videos".
        command: What the report says it was made by.
        progress: Whether to show a progress bar.

    Returns:
        The report.

    Raises:
        FileNotFoundError: The folder holds no finished study.
        ValueError: Its study.yaml is wrong.
    """
    study = load_study(folder / "study.yaml")
    learned = policies_of(study)
    chosen, episodes = conditions(study, learned), pd.read_parquet(folder / "episodes.parquet")
    made = {
        "outcomes": tables.outcomes(episodes),
        "shares": tables.shares(episodes, study.estimators[0]),
        "benefits": benefits(episodes),
        "transfer": tables.transfer(episodes, study),
        "constant_grip": pd.read_csv(folder / "constant_grip.csv"),
    }
    bar = tqdm(study.videos, desc="videos", unit="task", disable=not progress)
    scenes = [scene(study, task, chosen, episodes, folder / "videos") for task in bar]
    page = render(study, episodes, made, [each for each in scenes if each], missing(study, learned), command)
    atomic_io.write(folder / "report.html", page.encode())
    return folder / "report.html"


def render(
    study: Study,
    episodes: pd.DataFrame,
    made: Mapping[str, pd.DataFrame],
    scenes: Sequence[Scene],
    missing_policies: Sequence[str],
    command: str,
) -> str:
    """The report as text.

    Args:
        study: The study.
        episodes: Its episodes.
        made: Its tables: "outcomes", "shares", "benefits", "transfer" and "constant_grip".
        scenes: Videos.
        missing_policies: What was left out, in words.
        command: What it was made by.
    """
    outcomes, shares, transfer = (made[name] for name in ("outcomes", "shares", "transfer"))
    plain, changed = where(outcomes, change=""), without(outcomes, "change", "")
    fractions = where(shares, world=study.worlds[0].label)
    main = where(plain, world=study.worlds[0].label, preset=study.presets[0])
    places = [
        {
            "world": world,
            "preset": preset,
            "tasks": [(task, records(rows)) for (task,), rows in groups(group, ["task"])],
        }
        for (world, preset), group in groups(without(plain, "task", ALL), ["world", "preset"])
    ]
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    environment.filters.update(FILTERS)
    return environment.from_string(_TEMPLATE.read_text(encoding="utf-8")).render(
        study=study,
        answers=answers(study, outcomes, shares),
        titles=TITLES,
        tiles=_tiles(main),
        benefits=records(where(made["benefits"], world=study.worlds[0].label)),
        pictures=_pictures(study, plain, changed, fractions, transfer),
        places=places,
        shares=records(fractions),
        transfer=records(transfer),
        constant=records(made["constant_grip"]),
        transfer_most=TRANSFER_MOST,
        scenes=scenes,
        embedded=_embedded,
        missing=missing_policies,
        command=command,
        digest=sources(),
        episodes=len(episodes),
        versions={name: version for name, version in versions().items() if version},
        described=yaml.safe_dump(study.model_dump(mode="json"), sort_keys=False, allow_unicode=True),
    )


def _tiles(main: pd.DataFrame) -> list[tuple[str, str, list[dict[str, Any]]]]:
    """Kind, task and the rows of its sources, if there are several: of all tasks, or of the only one."""
    tiles = []
    for (kind,), group in groups(main, ["kind"]):
        task = ALL if ALL in distinct(group, "task") else distinct(group, "task")[0]
        rows = where(group, task=task).drop_duplicates("source")
        if len(rows) > 1:
            tiles.append((str(kind), task, records(rows)))
    return tiles


def _pictures(
    study: Study, plain: pd.DataFrame, changed: pd.DataFrame, fractions: pd.DataFrame, transfer: pd.DataFrame
) -> dict[str, Any]:
    """Every figure as an element; by preset or kind where there is one for each."""
    first = where(plain, world=study.worlds[0].label)
    pictures: dict[str, Any] = {
        "success": {},
        "shares": {},
        "estimators": {},
        "degradation": {},
        "transfer": "",
    }
    estimator, *others = study.estimators
    with styled():
        for (preset,), group in groups(first, ["preset"]):
            success = plot_success(group, estimator)
            pictures["success"][preset] = inline(success, f"Episodes solved, {preset}")
            if others:
                compared = plot_estimators(group, study.estimators)
                pictures["estimators"][preset] = inline(compared, f"Episodes solved by estimator, {preset}")
            if len(part := where(fractions, preset=preset)):
                pictures["shares"][preset] = inline(plot_shares(part), f"Share of the truth, {preset}")
        for (kind,), group in groups(changed, ["kind"]):
            worse = plot_degradation(group)
            pictures["degradation"][kind] = inline(worse, f"Episodes solved as things get worse, {kind}")
        if len(transfer):
            pictures["transfer"] = inline(plot_transfer(transfer), "From the planar engine to PyBullet")
    return pictures


def _embedded(path: Path) -> str:
    return "data:video/mp4;base64," + base64.b64encode(path.read_bytes()).decode("ascii")
