"""Stick-slip in every material with velocities of an age that "adaptive" is not given: mean mu_c."""

from __future__ import annotations

import numpy as np
import pandas as pd

from policies.leaderboard.imperfect import unknown_delay
from policies.leaderboard.scenario import relative, replay
from policies.leaderboard.scenarios import Effort


def delays(effort: Effort) -> pd.DataFrame:
    """Errors of "adaptive" with velocities 0 to 2 samples late; see `unknown_delay`.

    Args:
        effort: How much is run.

    Returns:
        A row for each material and delay: `records`, the mean error of mu_c over all of them [%], the largest
        size of the mean error over one record [%], the share of records whose mean error is within 5 % [%].
    """
    rows = []
    for material in effort.materials:
        for scenario in unknown_delay(effort, material):
            means = []
            for run in scenario.runs:
                made = replay("adaptive", run.record, scenario.assumed)
                means.append(100.0 * relative(run, made, "mu_c").mean(axis=1))
            found = np.concatenate(means)
            rows.append(
                {
                    "material": material,
                    "velocity late by": scenario.name,
                    "records": len(found),
                    "mean error": float(found.mean()),
                    "largest": float(np.abs(found).max()),
                    "within 5 %": float(100.0 * np.mean(np.abs(found) <= 5.0)),
                }
            )
    return pd.DataFrame(rows)
