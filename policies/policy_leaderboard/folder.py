"""Writes the leaderboard of policies as a folder."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from policies.evaluation.folder import stamped
from policies.evaluation.plots.style import STYLE, styled
from policies.policy_leaderboard.picture import plot_policies
from policies.versions import write_versions
from slipgym.atomic_io import new_folder


def write(table: pd.DataFrame, output: Path) -> Path:
    """Writes the table and the picture, whole or not at all.

    Args:
        table: Of all tasks and levels, from `policies.policy_leaderboard.run.outcomes`.
        output: Folder of the run's own folder.

    Returns:
        The folder: `policies.csv`, `policies.png`, `versions.json`.
    """
    place = stamped(output, "policies")
    with new_folder(place) as folder:
        table.to_csv(folder / "policies.csv", index=False, float_format="%.3f")
        with styled():
            plot_policies(table).savefig(folder / "policies.png", dpi=STYLE.dpi)
        write_versions(folder)
    return place
