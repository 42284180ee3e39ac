"""Runs a study and writes its folder."""

from __future__ import annotations

import os
from pathlib import Path

from policies.evaluation.folder import write_origin
from policies.study import tables
from policies.study.benefit import benefits
from policies.study.conditions import conditions
from policies.study.config import Study
from policies.study.constant_grip import constant_grips
from policies.study.episodes import episodes
from policies.study.learned import missing, policies_of
from policies.study.store import Store
from slipgym import atomic_io


def run_study(
    study: Study,
    output: str | os.PathLike[str] = "runs",
    jobs: int = 1,
    progress: bool = True,
) -> Path:
    """Runs what a study has not run yet, and writes its tables.

    Args:
        study: From `load_study`.
        output: Folder that the study's own folder goes to; finished conditions are not run again.
        jobs: Processes; -1 for one per core. The results do not depend on it.
        progress: Whether to show progress bars.

    Returns:
        The study's folder, <output>/study__<name>__<seed>.

    Raises:
        ValueError: There is nothing to run, or a policy refuses the observations.
        OSError: The output cannot be written.
    """
    folder = Path(output).expanduser().resolve() / f"study__{study.name}__{study.seed}"
    learned = policies_of(study)
    chosen = conditions(study, learned)
    if not chosen:
        raise ValueError(f"{study.name}: no condition to run; {'; '.join(missing(study, learned))}")
    done = episodes(study, chosen, Store(folder / "conditions", study), jobs, progress)
    made = {
        "outcomes": tables.outcomes(done),
        "shares": tables.shares(done, study.estimators[0]),
        "benefits": benefits(done),
        "transfer": tables.transfer(done, study),
        "constant_grip": constant_grips(study, folder / "constant_grip", progress=progress),
    }
    write_origin(folder, study=study.model_dump(mode="json"))
    atomic_io.write(folder / "episodes.parquet", done.to_parquet(index=False))
    for name, table in made.items():
        atomic_io.write(folder / f"{name}.csv", table.to_csv(index=False).encode())
    return folder
