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

from policies.evaluation.frames import distinct, records, where, without
from policies.evaluation.plots.style import styled
from policies.study import figures
from policies.study.conditions import Condition
from policies.study.config import Study
from policies.study.figures.differences import TRANSFER_MOST
from policies.study.figures.inline import inline
from policies.study.formats import FILTERS
from policies.study.sentences import answers
from policies.study.store import sources
from policies.study.tables import ALL, by
from policies.study.videos import Scene, scene
from policies.versions import versions
from slipgym import atomic_io

TITLES = {
    "classic": "The controllers",
    "memory": "The controllers with a memory of slips",
    "learned": "The learned policies",
    "imitation": "The imitations",
}
"""What the report calls the kinds of policies."""
_TEMPLATE = Path(__file__).parent / "report.html.j2"


def write_page(
    study: Study,
    conditions: Sequence[Condition],
    episodes: pd.DataFrame,
    tables: Mapping[str, pd.DataFrame],
    missing: Sequence[str],
    command: str,
    folder: Path,
    progress: bool = True,
) -> None:
    """Writes report.html, whole.

    Args:
        study: The study.
        conditions: All its conditions.
        episodes: Their episodes.
        tables: "outcomes", "shares", "benefits", "transfer" and "constant_grip".
        missing: What was left out, in words.
        command: What it was made by.
        folder: The study's folder; videos are kept in its "videos".
        progress: Whether to show a progress bar.
    """
    bar = tqdm(study.videos, desc="videos", unit="task", disable=not progress)
    scenes = [scene(study, task, conditions, episodes, folder / "videos") for task in bar]
    page = render(study, episodes, tables, [each for each in scenes if each], missing, command)
    atomic_io.write(folder / "report.html", page.encode())


def render(
    study: Study,
    episodes: pd.DataFrame,
    tables: Mapping[str, pd.DataFrame],
    scenes: Sequence[Scene],
    missing: Sequence[str],
    command: str,
) -> str:
    """The report as text; arguments as of `write_page`."""
    outcomes, shares, transfer = (tables[name] for name in ("outcomes", "shares", "transfer"))
    plain, changed = where(outcomes, change=""), without(outcomes, "change", "")
    fractions = where(shares, world=study.worlds[0].label)
    main = where(plain, world=study.worlds[0].label, preset=study.presets[0])
    places = [
        {
            "world": world,
            "preset": preset,
            "tasks": [(task, records(rows)) for (task,), rows in by(group, ["task"])],
        }
        for (world, preset), group in by(without(plain, "task", ALL), ["world", "preset"])
    ]
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    environment.filters.update(FILTERS)
    return environment.from_string(_TEMPLATE.read_text(encoding="utf-8")).render(
        study=study,
        answers=answers(study, outcomes, shares),
        titles=TITLES,
        tiles=_tiles(main),
        benefits=records(where(tables["benefits"], world=study.worlds[0].label)),
        pictures=_pictures(study, plain, changed, fractions, transfer),
        places=places,
        shares=records(fractions),
        transfer=records(transfer),
        constant=records(tables["constant_grip"]),
        transfer_most=TRANSFER_MOST,
        scenes=scenes,
        embedded=_embedded,
        missing=missing,
        command=command,
        digest=sources(),
        episodes=len(episodes),
        versions={name: version for name, version in versions().items() if version},
        described=yaml.safe_dump(study.model_dump(mode="json"), sort_keys=False, allow_unicode=True),
    )


def _tiles(main: pd.DataFrame) -> list[tuple[str, str, list[dict[str, Any]]]]:
    """Kind, task and the rows of its sources, if there are several: of all tasks, or of the only one."""
    tiles = []
    for (kind,), group in by(main, ["kind"]):
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
        for (preset,), group in by(first, ["preset"]):
            success = figures.plot_success(group, estimator)
            pictures["success"][preset] = inline(success, f"Episodes solved, {preset}")
            if others:
                compared = figures.plot_estimators(group, study.estimators)
                pictures["estimators"][preset] = inline(compared, f"Episodes solved by estimator, {preset}")
            if len(part := where(fractions, preset=preset)):
                pictures["shares"][preset] = inline(
                    figures.plot_shares(part), f"Share of the truth, {preset}"
                )
        for (kind,), group in by(changed, ["kind"]):
            worse = figures.plot_degradation(group)
            pictures["degradation"][kind] = inline(worse, f"Episodes solved as things get worse, {kind}")
        if len(transfer):
            pictures["transfer"] = inline(
                figures.plot_transfer(transfer), "From the planar engine to PyBullet"
            )
    return pictures


def _embedded(path: Path) -> str:
    return "data:video/mp4;base64," + base64.b64encode(path.read_bytes()).decode("ascii")
