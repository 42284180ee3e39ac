"""Runs a study and writes its folder, with the best constant grip of each task: it reacts to nothing."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

from tqdm import tqdm

from policies.evaluation.plan import plan
from policies.policy_leaderboard.entries import constants, strongest
from policies.study import tables
from policies.study.conditions import conditions, experiment_of, first_preset, missing, policies_of
from policies.study.config import BLOCKS_MAX, Study
from policies.study.store import Store, episodes, mark
from policies.versions import write_origin
from slipgym import atomic_io

CANDIDATES = 24
"""Constant forces that are tried, spaced geometrically over the gripper's range."""
_SELECTION_SEED = 10**9
"""Beyond the seeds of all blocks: a force is chosen on other episodes than those it is evaluated on."""


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
    atomic_io.check_folder(folder.parent)
    learned = policies_of(study)
    absent = missing(study, learned)
    if not conditions(study, learned):
        raise ValueError("; ".join([f"{study.name}: no condition to run", *absent]))
    for words in absent:
        print(f"left out: {words}", file=sys.stderr)
    forces = constant_grips(study, folder / "constant_grip", progress=progress)
    chosen = conditions(study, learned, forces)
    done = episodes(study, chosen, Store(folder / "conditions", study), jobs, progress)
    outcomes = tables.outcomes(done)
    made = {
        "outcomes": outcomes,
        "shares": tables.shares(done, study.estimators[0]),
        "benefits": tables.benefits(done),
        "transfer": tables.transfer(done, study),
        "constant_grip": tables.constant_grip(outcomes, forces),
    }
    write_origin(folder, study=study.model_dump(mode="json"))
    atomic_io.write(folder / "episodes.parquet", done.to_parquet(index=False))
    for name, table in made.items():
        atomic_io.write(folder / f"{name}.csv", table.to_csv(index=False).encode())
    return folder


def constant_grips(
    study: Study, folder: Path, candidates: int = CANDIDATES, progress: bool = True
) -> dict[str, float]:
    """The best constant grip of each task of a study [N].

    It is chosen on other episodes than those of the study, of the first world and its first preset, but on
    the planar engine. So it is tuned to their distribution, which nobody could do for a single new object.
    The folder keeps it.
    """
    found = {}
    for task in tqdm(study.tasks, desc="constant grips", unit="task", disable=not progress):
        values = {
            "name": f"constant_{task.rpartition(':')[2]}",
            "task": task,
            "seed": BLOCKS_MAX * study.seed + _SELECTION_SEED,
            "trials": study.blocks * study.episodes,
            "policies": [{"name": "constant_force"}],
            "friction": [{"source": "none"}],
            "engine": "planar",
            "randomization": first_preset(study),
        }
        experiment = experiment_of(study, study.worlds[0].contact, values)
        path = folder / f"{experiment.name}__{mark(experiment, str(candidates))}.json"
        if not path.exists():
            members = constants(experiment.environment_config().gripper, candidates, experiment.config)
            seeds = [trial.seed for trial in plan(experiment)]
            policy: Any = strongest(task, members, experiment.arguments, seeds).policy
            with atomic_io.new_file(path) as partial:
                partial.write_text(json.dumps({"force_N": policy.force}), encoding="utf-8")
        found[task] = json.loads(path.read_text(encoding="utf-8"))["force_N"]
    return found
