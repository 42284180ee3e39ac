"""The tables of a study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd

from policies.evaluation.frames import distinct, groups, values, where
from policies.evaluation.gain import WITHOUT, Entry, ranked
from policies.evaluation.statistics import Bootstrap, Drawn, Interval, over_seeds, share, spread
from policies.study.config import Study

PLACE = ["world", "task", "preset", "change", "level", "kind"]
FRICTION = ["source", "estimator"]
SHARES = [
    *("world", "task", "preset", "kind", "figure", "n"),
    *(f"{name}{end}" for name in ("true-none", "estimated-none", "share") for end in ("", "_low", "_high")),
    "verdict",
]
"""Columns of the table of shares."""
TRANSFER = [
    *("contact", "task", "preset", "kind", "n"),
    *(f"{name}{end}" for name in ("core", "bullet", "difference") for end in ("", "_low", "_high")),
]
"""Columns of the table of transfer."""
ALL = "all tasks"
TRAINED = "learned", "imitation"
"""Kinds of policies that have training seeds."""
ENOUGH = 0.8
NOTHING = Interval(np.nan, np.nan, np.nan)
FIGURES = "success", "return"
"""Columns of an episode whose means are compared."""


def outcomes(episodes: pd.DataFrame) -> pd.DataFrame:
    """Success, drops, return and grip force of each condition.

    There are rows for the success over all tasks, too, of the tasks that have every source; returns of
    different tasks are not averaged. Shares have Wilson intervals, the mean return a bootstrap interval
    stratified over the blocks. `seeds` is the interquartile mean of the success over the training seeds of a
    learned policy, of which each acts in a block of its own.
    """
    rows, condition = [], [*PLACE, *FRICTION]
    together = (part.assign(task=ALL) for _, part in _over_tasks(episodes))
    for keys, group in (found for part in (episodes, *together) for found in groups(part, condition)):
        figures = {name: share(values(group, name)) for name in ("success", "dropped")}
        if keys[1] != ALL:
            bootstrap = Bootstrap(values(group, "block"))
            figures["return"] = bootstrap(values(group, "return")).interval
            figures["force"] = bootstrap(values(group, "mean_force_N")).interval
        by_block = [float(values(part, "success").mean()) for _, part in groups(group, ["block"])]
        if keys[PLACE.index("kind")] in TRAINED:
            figures["seeds"] = over_seeds(by_block)
        counts = {"n": len(group), "blocks": " ".join(f"{each:.3f}" for each in by_block)}
        rows.append(dict(zip(condition, keys, strict=True)) | counts | spread(figures))
    return pd.DataFrame(rows)


def constant_grip(outcomes: pd.DataFrame, forces: Mapping[str, float]) -> pd.DataFrame:
    """Of the outcomes, those of the best constant grip of each task, with its force [N]."""
    figures = [f"{name}{end}" for name in ("success", "dropped", "return") for end in ("", "_low", "_high")]
    found = where(outcomes, kind="constant")
    found = found.assign(force_N=[forces[task] for task in found["task"]])
    return found.loc[:, ["task", "force_N", "n", *figures]]


def shares(episodes: pd.DataFrame, estimator: str) -> pd.DataFrame:
    """Share of the truth's benefit that the main estimator recovers: (estimated - none) / (true - none).

    Returns:
        Columns `SHARES`: a row for each place and figure, and for the success over all tasks of a place.
        `verdict` is "yes" or "no" where true - none is significantly positive: whether the share is at least
        `ENOUGH`. Else it says why there is no share.
    """
    rows = []
    plain = where(episodes, change="")
    for keys, group in [*groups(plain, ["world", "task", "preset", "kind"]), *_over_tasks(plain)]:
        parts = {source: where(group, source=source) for source in ("none", "true")}
        parts["estimated"] = where(group, source="estimated", estimator=estimator)
        if min(map(len, parts.values())) == 0:
            continue
        bootstrap = Bootstrap(strata(parts["true"]))
        for column in FIGURES:
            if column == "return" and keys[1] == ALL:
                continue
            drawn = {name: bootstrap(values(part, column)) for name, part in parts.items()}
            row = dict(zip(["world", "task", "preset", "kind"], keys, strict=True))
            rows.append({**row, "figure": column, "n": len(parts["true"]), **_share(drawn)})
    return pd.DataFrame(rows, columns=SHARES)


def transfer(episodes: pd.DataFrame, study: Study) -> pd.DataFrame:
    """Success on PyBullet less that on the planar engine with the same contact, over pairs [points]."""
    main = where(episodes, change="", source="estimated", estimator=study.estimators[0])
    same = ["task", "preset", "kind", "block", "episode"]
    rows = []
    for planar in (world for world in study.worlds if world.engine == "planar"):
        for bullet in (w for w in study.worlds if w.engine == "bullet" and w.contact == planar.contact):
            here, there = (where(main, world=world.label) for world in (planar, bullet))
            pairs = here.merge(there, on=same, suffixes=("_core", ""))
            for keys, group in [*groups(pairs, ["task", "preset", "kind"]), *_all(pairs)]:
                bootstrap = Bootstrap(strata(group))
                core, bench = values(group, "success_core"), values(group, "success")
                difference = bootstrap(100.0 * bench) - bootstrap(100.0 * core)
                row = dict(zip(["task", "preset", "kind"], keys, strict=True))
                figures = {"core": share(core).percent, "bullet": share(bench).percent}
                figures |= {"difference": difference.interval}
                rows.append({"contact": planar.contact, **row, "n": len(group), **spread(figures)})
    return pd.DataFrame(rows, columns=pd.Index(TRANSFER))


def _share(drawn: dict[str, Drawn]) -> dict[str, Any]:
    whole, part = drawn["true"] - drawn["none"], drawn["estimated"] - drawn["none"]
    recovered = NOTHING
    if whole.interval.low > 0.0:
        recovered = part.share_of(whole).interval
        verdict = "yes" if recovered.value >= ENOUGH else "no"
    else:
        verdict = "the truth does harm" if whole.interval.high < 0.0 else "not significant"
    figures = {"true-none": whole.interval, "estimated-none": part.interval, "share": recovered}
    return {**spread(figures), "verdict": verdict}


def _over_tasks(episodes: pd.DataFrame) -> Iterator[tuple[tuple[str, ...], pd.DataFrame]]:
    """The episodes of all tasks that have every source together, where there are several."""
    plain = where(episodes, change="")
    for (world, preset, kind), group in groups(plain, ["world", "preset", "kind"]):
        complete = [
            part
            for _, part in groups(group, ["task"])
            if {"none", "estimated", "true"} <= set(part["source"])
        ]
        if len(complete) > 1:
            yield (world, ALL, preset, kind), pd.concat(complete)


def _all(pairs: pd.DataFrame) -> Iterator[tuple[tuple[str, ...], pd.DataFrame]]:
    for key, group in groups(pairs, ["preset", "kind"]):
        if len(distinct(group, "task")) > 1:
            yield (ALL, *key), group


def strata(episodes: pd.DataFrame) -> np.ndarray:
    """A stratum for each task and block."""
    return np.asarray(episodes.groupby(["task", "block"], sort=False).ngroup())


WIDEST = 0.4
"""Width of a share's interval beyond which the share is not stated."""
_PLACE, _POLICY = ["world", "task", "preset"], ["kind", *FRICTION]
COLUMNS = [
    *(*_PLACE, "opponent", *_POLICY, "n"),
    *(f"{name}{end}" for name in ("difference", "share") for end in ("", "_low", "_high")),
    "verdict",
]
"""Columns of the table of benefits."""


def benefits(episodes: pd.DataFrame) -> pd.DataFrame:
    """Success of each policy with friction information less that of the strongest one without, in pairs.

    The opponent is the strongest policy with no or with nominal friction in a place, the oracle the strongest
    with the true friction. The share is (policy - opponent) / (oracle - opponent).

    Returns:
        Columns `COLUMNS`: a row for each policy with friction information. `verdict` is "better", "worse" or
        "not resolvable" by the interval of the difference; a share whose interval is wider than `WIDEST`, or
        of an oracle that is not better than the opponent, is NaN.
    """
    rows = []
    for place, group in groups(where(episodes, change=""), _PLACE):
        group = group.sort_values(["block", "episode"])
        parts = dict(groups(group, _POLICY))
        entries = [
            Entry(
                f"{kind} nominal" if source == "nominal" else kind,
                source,
                values(part, "success"),
                values(part, "return"),
                friction,
            )
            for (kind, source, friction), part in parts.items()
        ]
        opponents, oracles = ranked(entries, WITHOUT), ranked(entries, ["true"])
        if not opponents:
            continue
        bootstrap = Bootstrap(strata(next(iter(parts.values()))))
        without = bootstrap(opponents[-1].success)
        whole = bootstrap(oracles[-1].success) - without if oracles else None
        for entry in (entry for entry in entries if entry.source not in WITHOUT):
            gain, share = bootstrap(entry.success) - without, NOTHING
            if whole is not None and whole.interval.low > 0.0:
                found = gain.share_of(whole).interval
                share = found if found.high - found.low <= WIDEST else NOTHING
            names = [opponents[-1].policy, entry.policy, entry.source, entry.friction, len(entry.success)]
            row: dict[str, Any] = dict(zip(COLUMNS, [*place, *names], strict=False))
            verdict = _verdict(gain.interval)
            rows.append(row | spread({"difference": gain, "share": share}) | {"verdict": verdict})
    return pd.DataFrame(rows, columns=pd.Index(COLUMNS))


def _verdict(difference: Interval) -> str:
    """Whether the interval of the difference leaves 0 out, and on which side."""
    if difference.low > 0.0:
        return "better"
    return "worse" if difference.high < 0.0 else "not resolvable"
