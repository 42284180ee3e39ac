"""Adds the best constant grip of each task to a study: what a policy reaches that reacts to nothing."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd

from policies.evaluation.constant_grip import CANDIDATES, best_force, run_constant
from policies.evaluation.statistics import mean_interval, share, spread
from policies.study.conditions import experiment_of
from policies.study.config import Study
from policies.study.store import mark
from slipgym.atomic_io import new_file


def constant_grips(
    study: Study, folder: Path, candidates: int = CANDIDATES, progress: bool = True
) -> pd.DataFrame:
    """Success, drops and return of the best constant grip of each task of a study.

    The episodes are those of the first preset, on the planar engine, as many as a condition has. The folder
    keeps finished tasks, which are not run again.

    Returns:
        A row for each task: `task`, `force_N` [N], `n`, and with intervals `success`, `dropped`, `return`.
    """
    rows = []
    contacts = [world.contact for world in study.worlds if world.engine == "planar"]
    for task in study.tasks:
        values = {
            "name": f"constant_{task.rpartition(':')[2]}",
            "task": task,
            "seed": study.seed,
            "trials": study.blocks * study.episodes,
            "policies": [{"name": "constant_force"}],
            "friction": [{"source": "none"}],
            "engine": "planar",
            "randomization": study.presets[0],
        }
        experiment = experiment_of(study, contacts[0] if contacts else "ellipsoid", values)
        path = folder / f"{experiment.name}__{mark(experiment, str(candidates))}.json"
        if not path.exists():
            force = best_force(experiment, candidates, progress)
            found = run_constant(experiment, [force], progress=False)[0].played
            shares = {"success": share(found.success), "dropped": share(found.dropped)}
            figures = spread({**shares, "return": mean_interval(found.reward)})
            row = {"task": task, "force_N": force, "n": len(found.success), **figures}
            with new_file(path) as partial:
                partial.write_text(json.dumps(row), encoding="utf-8")
        rows.append(json.loads(path.read_text(encoding="utf-8")))
    return pd.DataFrame(rows)
