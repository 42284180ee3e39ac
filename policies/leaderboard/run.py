"""The leaderboard: all estimators on all scenarios."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from tqdm import tqdm

import estimator
from policies.evaluation.frames import markdown, values
from policies.evaluation.plots.style import STYLE, styled
from policies.leaderboard import imperfect, scenarios
from policies.leaderboard.ranking import plot_leaderboard, ranked, winners
from policies.leaderboard.scenario import FIELDS, FIGURES, Scenario, replay, score
from policies.leaderboard.scenarios import Effort, effort_of
from policies.versions import stamped, write_versions
from slipgym.atomic_io import check_folder, new_folder

GROUPS: tuple[Callable[[Effort], Iterator[Scenario]], ...] = (
    *(scenarios.profiles, scenarios.stick_slip, scenarios.planar, scenarios.start_values),
    *(scenarios.spin_first, scenarios.noise, scenarios.pressure, scenarios.latency),
    *(imperfect.unknown_delay, imperfect.sensor_errors, imperfect.jumps),
    *(imperfect.drifts, imperfect.load_dependent, imperfect.anisotropic),
)
"""The groups of scenarios; another one is one more function."""
Entrants = dict[str, tuple[str, dict[str, object]]]
"""Label -> name and parameters of an estimator."""


def entrants(own: Sequence[str] = ()) -> Entrants:
    """Every estimator as it is made by its name, the paper's without its heuristic, and the user's own.

    Raises:
        ValueError: One of the user's, "module:attribute", cannot be made.
    """
    for name in own:
        estimator.make(name)
    rows: Entrants = {name: (name, {}) for name in (*estimator.names(), *own)}
    rows["rls, plain"] = "rls", {"heuristic": False}
    return rows


def run_leaderboard(
    output: str | os.PathLike[str] = "runs",
    quick: bool = False,
    seed: int = 0,
    progress: bool = True,
    own: Sequence[str] = (),
) -> Path:
    """Runs all estimators on all scenarios and ranks them.

    Args:
        output: Folder that the run's own folder goes to.
        quick: Whether a few coarse records will do, for a test of the machinery.
        seed: Of the sensors' noise.
        progress: Whether to show a progress bar.
        own: Further estimators to enter, as "module:attribute".

    Returns:
        The run's folder: leaderboard.md, ranking.csv, scenarios.csv, leaderboard.png.
    """
    effort, taking_part = effort_of(quick, seed), entrants(own)
    check_folder(Path(output))
    rows = []
    with tqdm(GROUPS, desc="leaderboard", unit="group", disable=not progress) as groups:
        for group in groups:
            for scenario in group(effort):
                groups.set_postfix_str(f"{scenario.group} {scenario.name}")
                rows += evaluate(scenario, taking_part)
    table = pd.DataFrame(rows)
    ranking, best = ranked(table), winners(table)
    path = stamped(output, "leaderboard")
    with new_folder(path) as folder:
        write_versions(folder)
        table.to_csv(folder / "scenarios.csv", index=False)
        ranking.to_csv(folder / "ranking.csv", index=False)
        (folder / "leaderboard.md").write_text(page(table, ranking, best), encoding="utf-8")
        with styled():
            plot_leaderboard(table, ranking).savefig(folder / "leaderboard.png", dpi=STYLE.dpi)
    return path


def evaluate(scenario: Scenario, chosen: Entrants | None = None) -> list[dict[str, object]]:
    """A row for each of the chosen entrants; None: for all."""
    rows = []
    for label, (name, parameters) in (entrants() if chosen is None else chosen).items():
        made = [
            replay(name, run.record, scenario.assumed, scenario.starts, **parameters) for run in scenario.runs
        ]
        figures = score(scenario, made)
        rows.append({"group": scenario.group, "scenario": scenario.name, "estimator": label, **figures})
    return rows


def page(table: pd.DataFrame, ranking: pd.DataFrame, best: pd.DataFrame) -> str:
    """The tables as a page."""
    parts = ["# Leaderboard of the estimators", "Errors in %.", markdown(ranking)]
    parts += ["## The best, by group", markdown(best)]
    for field in FIELDS:
        figures = {f"{figure}_{field}": figure for figure in FIGURES}
        parts += [f"## {field}", markdown(_seen(table, f"error_{field}", figures))]
    parts += ["## Lock-ups, share of start values", markdown(_seen(table, "lock_ups", {"lock_ups": "share"}))]
    return "\n\n".join(part.rstrip() for part in parts) + "\n"


def _seen(table: pd.DataFrame, needed: str, columns: dict[str, str]) -> pd.DataFrame:
    """The rows that have a figure; some columns of them, renamed."""
    keys = {name: name for name in ("group", "scenario", "estimator")}
    rows = table.loc[np.isfinite(values(table, needed))]
    return pd.DataFrame({new: rows[old] for old, new in (keys | columns).items()})
