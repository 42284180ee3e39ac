"""Measures what each state and each test of "adaptive" is worth: without it, on the same records."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from tqdm import tqdm

from lab.leaderboard.opened import opened
from policies.evaluation.frames import values, where
from policies.leaderboard.closed_loop import closed_loop
from policies.leaderboard.groups import GROUPS
from policies.leaderboard.ranking import by_group, ranked
from policies.leaderboard.run import Entrants, evaluate
from policies.leaderboard.scenario import FIELDS
from policies.leaderboard.scenarios import Effort

NONE = 1e-9
"""A spread or a drift that is as good as 0, which is not allowed."""
NEVER = 1e9
"""A limit that nothing reaches."""
FULL = "nothing"
WITHOUT: dict[str, dict[str, object]] = {
    FULL: {},
    "search for the delay": {"timing_gate": 1.0 - NONE},
    "zero error of the force": {"sd_zero": NONE, "walk_force": 0.0},
    "zeroing while unloaded": {"eps_open": 0.0},
    "tilt of the sensor": {"sd_tilt": NONE},
    "CoP": {"sd_cop": NONE},
    "drift of these errors": {"error_drift": 0.0},
    "caution": {"caution": 1.0},
    "viscosity": {"viscosity0": 0.0, "sd_viscosity": NONE},
    "learning the viscosity": {"sd_viscosity": NONE},
    "shape of the surface": {"sd_shape": NONE},
    "drift of mu_c and r": {"drift": NONE, "drift_at_rest": 0.0},
    "test for jumps": {"jump_limit": NEVER},
    "test for changes at rest": {"jump_odds": NEVER},
    "new exponent after a jump": {"jump_forgets_exponent": False},
    "noise for outliers": {"outlier": NEVER},
    "search for the error of the law": {"law_gain": 0.0},
    "error of the direction": {"turn_error": 0.0},
    "noise where the grip closes": {"grip_noise": False},
    "static friction of slow slips": {"stribeck_velocity": NONE},
    "short slips": {"short_slips": False},
    "compliance of the pad": {"compliance": 0.0, "compliance_max": 0.0},
    "dependence on the load": {
        "load_exponent0": 0.0,
        "sd_load_exponent": NONE,
        "radius_exponent0": 0.0,
        "sd_radius_exponent": NONE,
    },
    "hard pads": {"hard": 0.0},
    "evidence of jumps": {"jump_evidence": 0.0},
    "mu_s from sticks": {"mu_s_from_sticks": False},
    "mu_s with changes of mu_c": {"mu_s_follows": False},
    "exponent from sticks": {"exponent_from_sticks": False},
    "tilt from sticks": {"tilt_from_sticks": False},
    "torsion from turns": {"torsion_from_turns": False},
    "what slips share": {"sd_slip": NONE, "sd_surface": 0.0, "sd_fall": 0.0},
    "drift of mu_s": {"drift_mu_s": 0.0},
    "new start of mu_s": {"jump_mu_s": float("inf")},
}
"""What is removed -> the parameters that remove it."""


def ablation(effort: Effort, progress: bool = True) -> pd.DataFrame:
    """Runs "adaptive" on all scenarios, each time without one thing.

    Args:
        effort: How much is run.
        progress: Whether to show a progress bar.

    Returns:
        A row per scenario and removed thing, as in the leaderboard; the latter is `estimator`.
    """
    chosen: Entrants = {label: ("adaptive", parameters) for label, parameters in WITHOUT.items()}
    rows = []
    with tqdm((*GROUPS, opened), desc="ablation", unit="group", disable=not progress) as groups:
        for group in groups:
            for scenario in group(effort):
                rows += evaluate(scenario, chosen)
    return pd.DataFrame(rows)


def worth(table: pd.DataFrame) -> pd.DataFrame:
    """What is lost without each thing, the most important first.

    Args:
        table: From `ablation`.

    Returns:
        `without`; `worst` [%] and its group, as in the ranking; typical errors of mu_c, r, mu_s [%]; shares
        of true mu_c and r within one stated deviation [%]; the group whose error of mu_c or r grows most, in
        percent points, from the full one to that without the thing. The full one comes first.
    """
    errors, ranking = by_group(table), ranked(table)
    full, rows = where(errors, estimator=FULL), []
    for row in ranking.to_dict("records"):
        own = where(errors, estimator=row["estimator"])
        cells = {(group, field): number for group, field, number in _cells(own)}
        largest = max(cells, key=lambda cell: cells[cell])
        before = {(group, field): number for group, field, number in _cells(full)}
        most = max(cells, key=lambda cell: cells[cell] - before[cell])
        grown = "–"
        if cells[most] - before[most] > 0.05:
            grown = f"{most[0]}, {most[1]}: {before[most]:.1f} → {cells[most]:.1f}"
        shown = {"without": row["estimator"], "worst": row["worst"], "in": f"{largest[0]}, {largest[1]}"}
        shown |= {field: row[field] for field in FIELDS}
        shown |= {f"{field} in sd": row[f"calibration_{field}"] for field in ("mu_c", "r")}
        rows.append({**shown, "loses most": grown})
    found = pd.DataFrame(rows)
    order = np.argsort(-values(found, "worst"), kind="stable")
    found = found.iloc[order]
    return pd.concat((where(found, without=FULL), found.loc[found["without"] != FULL]), ignore_index=True)


def in_the_loop(episodes: int, seed: int, **arguments: Any) -> pd.DataFrame:
    """The same in the loop, with the sensors "lab", over all tasks.

    Args:
        episodes: Of each task and removed thing; the same initial conditions in all.
        seed: Of the first episode.
        **arguments: Of the environments.

    Returns:
        `without`, `solved`, `dropped` [%], the errors of mu_s and mu_c and the shares of truths within one
        stated deviation [%], as in `closed_loop`: means over the tasks, of the errors geometric ones. r ends
        too few episodes with confidence for its error to say something.
    """
    choices = {label: {"name": "adaptive", **removed} for label, removed in WITHOUT.items()}
    played = closed_loop(choices, episodes, ("lab",), seed, **arguments)
    columns = ["solved", "dropped", "mu_s error", "mu_c error", "mu_s in 1 sd", "mu_c in 1 sd", "r in 1 sd"]
    rows = []
    for label in WITHOUT:
        own = where(played, estimator=label)
        rows.append(
            {"without": label, **{name: _mean(values(own, name), "error" in name) for name in columns}}
        )
    return pd.DataFrame(rows)


def _mean(figures: np.ndarray, geometric: bool) -> float:
    """Mean of the figures that are known; NaN if none is."""
    known = figures[np.isfinite(figures)]
    if not len(known):
        return np.nan
    return float(np.exp(np.log(known).mean()) if geometric else known.mean())


def _cells(errors: pd.DataFrame) -> list[tuple[str, str, float]]:
    """Group, quantity and error [%] of mu_c and r in each group that evaluates them."""
    rows = errors.to_dict("records")
    cells = [(row["group"], field, row[f"error_{field}"]) for row in rows for field in ("mu_c", "r")]
    return [cell for cell in cells if np.isfinite(cell[2])]
