"""The main result in words."""

from __future__ import annotations

import pandas as pd

from lab.frames import among, without
from lab.study_report.formats import figure, interval
from policies.evaluation.frames import distinct, records, where
from policies.study.config import Study
from policies.study.tables import ALL, ENOUGH


def answers(study: Study, outcomes: pd.DataFrame, shares: pd.DataFrame) -> list[tuple[str, list[str]]]:
    """What the study says about each kind of policy, in the first world and preset.

    Args:
        study: The study.
        outcomes: From `policies.study.tables.outcomes`.
        shares: From `policies.study.tables.shares`.

    Returns:
        Kind and sentences.
    """
    place = {"world": study.worlds[0].label, "preset": study.presets[0]}
    found = []
    for kind in distinct(where(outcomes, **place), "kind"):
        here = where(outcomes, **place, kind=kind, change="")
        known = where(shares, **place, kind=kind)
        sentences = [_level(where(here, task=_whole(here)), study.estimators[0])]
        if len(known):
            sentences += [_overall(known), _tasks(known)]
        found.append((kind, [sentence for sentence in sentences if sentence]))
    return found


def _whole(here: pd.DataFrame) -> str:
    tasks = distinct(here, "task")
    return ALL if ALL in tasks else tasks[0]


def _level(rows: pd.DataFrame, estimator: str) -> str:
    """Success of each source."""
    main = among(rows, "estimator", ("", estimator))
    words = [
        f"{figure(row, 'success', 100.0, 1)}\N{NO-BREAK SPACE}% with friction “{row['source']}”"
        for row in records(main)
    ]
    return f"Solved ({_whole(rows)}): " + ", ".join(words) + "."


def _overall(shares: pd.DataFrame) -> str:
    """The share of the success over all tasks."""
    rows = where(shares, task=_whole(shares), figure="success")
    if not len(rows):
        return ""
    (row,) = records(rows)
    ends = interval(row, "true-none", 100.0, 1) or "unknown, too few episodes"
    spread = f"95\N{NO-BREAK SPACE}% interval {ends}"
    gain = f"{figure(row, 'true-none', 100.0, 1)}\N{NO-BREAK SPACE}points ({spread})"
    if row["share"] != row["share"]:
        return f"Knowing the truth brings {gain}: {row['verdict']}, so there is no share to state."
    share = f"{figure(row, 'share', 100.0)}\N{NO-BREAK SPACE}% ({interval(row, 'share', 100.0)})"
    return f"Knowing the truth brings {gain}; the estimate recovers {share} of that."


def _tasks(shares: pd.DataFrame) -> str:
    """In how many comparisons the truth counts, and where the estimate recovers enough of it."""
    single = without(shares, "task", ALL)
    counts = among(single, "verdict", ("yes", "no"))
    if not len(counts):
        return "In no single task is the difference between true and no friction significant."
    enough = where(counts, verdict="yes")
    short = [f"{row['task']} ({row['figure']})" for row in records(where(counts, verdict="no"))]
    words = (
        f"True friction beats none significantly in {len(counts)} of {len(single)} cases, task × figure; "
        f"the estimate recovers at least {100 * ENOUGH:.0f}\N{NO-BREAK SPACE}% in {len(enough)} of these"
    )
    return words + (f", and less in {', '.join(short)}." if short else ".")
