"""Computes what friction information adds to the strongest opponent without it, over pairs of episodes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from policies.evaluation.frames import values, where
from policies.study.statistics import Bootstrap
from policies.study.tables import FRICTION, by, ends, strata

COLUMNS = [
    *("world", "task", "preset", "opponent", "kind", *FRICTION, "n"),
    *(f"{name}{end}" for name in ("difference", "share") for end in ("", "_low", "_high")),
    "verdict",
]
"""Columns of the table of benefits."""
WIDEST = 0.4
"""Width of a share's interval beyond which the share is not stated."""
_POLICY = ["kind", *FRICTION]


def benefits(episodes: pd.DataFrame) -> pd.DataFrame:
    """Success of each policy with friction information less that of the strongest one without, in pairs.

    The opponent is the kind of policy without friction information that solves most of a world, task and
    preset; the oracle is the policy with the true friction that solves most. The share is
    (policy - opponent) / (oracle - opponent).

    Args:
        episodes: The table of episodes.

    Returns:
        Columns `COLUMNS`: a row for each policy with friction information. `verdict` is "better", "worse" or
        "not resolvable" by the interval of the difference; a share whose interval is wider than `WIDEST`, or
        of an oracle that is not better than the opponent, is NaN.
    """
    rows = []
    for place, group in by(where(episodes, change=""), ["world", "task", "preset"]):
        solved = {
            (str(kind), str(source), str(name)): part.sort_values(["block", "episode"])
            for (kind, source, name), part in by(group, _POLICY)
        }
        opponents = {policy: part for policy, part in solved.items() if policy[1] == "none"}
        oracles = {policy: part for policy, part in solved.items() if policy[1] == "true"}
        if not opponents:
            continue
        opponent = max(opponents, key=lambda policy: values(opponents[policy], "success").mean())
        bootstrap = Bootstrap(strata(opponents[opponent]))
        drawn = {policy: bootstrap(values(part, "success")) for policy, part in solved.items()}
        best = max(oracles, key=lambda policy: drawn[policy].value, default=None)
        for policy in (policy for policy in solved if policy[1] != "none"):
            gain = drawn[policy] - drawn[opponent]
            row: dict[str, Any] = dict(zip(["world", "task", "preset"], place, strict=True))
            row |= {"opponent": opponent[0], **dict(zip(_POLICY, policy, strict=True))}
            row |= {"n": len(solved[policy]), **ends({"difference": gain})}
            share = _nothing()
            if best is not None and (whole := drawn[best] - drawn[opponent]).interval.low > 0.0:
                found = ends({"share": gain.share_of(whole)})
                share = found if found["share_high"] - found["share_low"] <= WIDEST else share
            rows.append({**row, **share, "verdict": _verdict(row)})
    return pd.DataFrame(rows, columns=pd.Index(COLUMNS))


def _nothing() -> dict[str, float]:
    return dict.fromkeys(("share", "share_low", "share_high"), np.nan)


def _verdict(row: dict[str, Any]) -> str:
    """Whether the interval of the difference leaves 0 out, and on which side."""
    if row["difference_low"] > 0.0:
        return "better"
    return "worse" if row["difference_high"] < 0.0 else "not resolvable"
