"""Computes what friction information adds to the strongest opponent without it, over pairs of episodes."""

from __future__ import annotations

from typing import Any

import pandas as pd

from policies.evaluation.frames import groups, values, where
from policies.evaluation.gain import Entry, ranked
from policies.evaluation.statistics import Bootstrap, Interval, spread
from policies.study.tables import FRICTION, NOTHING, strata

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

    The opponent is the strongest kind of policy without friction information in a place, the oracle the
    strongest policy with the true friction. The share is (policy - opponent) / (oracle - opponent).

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
            Entry(kind, source, values(part, "success"), values(part, "return"), friction)
            for (kind, source, friction), part in parts.items()
        ]
        opponents, oracles = ranked(entries, ["none"]), ranked(entries, ["true"])
        if not opponents:
            continue
        bootstrap = Bootstrap(strata(next(iter(parts.values()))))
        without = bootstrap(opponents[-1].success)
        whole = bootstrap(oracles[-1].success) - without if oracles else None
        for entry in (entry for entry in entries if entry.source != "none"):
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
