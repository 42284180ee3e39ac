"""Adds the best constant grip of each task to a study: what a policy reaches that reacts to nothing."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import pandas as pd

from policies.evaluation.constant_grip import CANDIDATES, best_force, run_constant
from policies.evaluation.experiment import Experiment
from policies.evaluation.statistics import mean_interval, share_interval
from policies.study.config import Study
from policies.study.store import sources
from policies.study.tables import spread
from slipgym import atomic_io
from slipgym.config.yaml_model import validate


def constant_grips(
    study: Study, folder: Path, candidates: int = CANDIDATES, progress: bool = True
) -> pd.DataFrame:
    """Success, drops and return of the best constant grip of each task of a study.

    The episodes are those of the first preset, on the planar engine, as many as a condition has.

    Args:
        study: The study.
        folder: Keeps finished tasks, which are not run again.
        candidates: Forces to try.
        progress: Whether to show progress bars.

    Returns:
        A row for each task: `task`, `force_N` [N], `n`, and with intervals `success`, `dropped`, `return`.
    """
    rows = []
    for task in study.tasks:
        experiment = _experiment(study, task)
        values = [experiment.model_dump_json(), str(candidates), sources()]
        digest = hashlib.sha256("\n".join(values).encode()).hexdigest()[:16]
        path = folder / f"{experiment.name}__{digest}.json"
        if not path.exists():
            folder.mkdir(parents=True, exist_ok=True)
            row = {"task": task, **_outcomes(experiment, candidates, progress)}
            atomic_io.write(path, json.dumps(row).encode())
        rows.append(json.loads(path.read_text(encoding="utf-8")))
    return pd.DataFrame(rows)


def _experiment(study: Study, task: str) -> Experiment:
    contacts = [world.contact for world in study.worlds if world.engine == "planar"]
    contact = {**study.config.get("contact", {}), "model": contacts[0] if contacts else "ellipsoid"}
    values = {
        "name": f"constant_{task.rpartition(':')[2]}",
        "task": task,
        "seed": study.seed,
        "trials": study.blocks * study.episodes,
        "policies": [{"name": "constant_force"}],
        "friction": [{"source": "none"}],
        "engine": "planar",
        "randomization": study.presets[0],
        "level": study.level,
        "sensors": study.sensors,
        "config": {**study.config, "contact": contact},
    }
    return validate(values, Experiment, study.name)


def _outcomes(experiment: Experiment, candidates: int, progress: bool) -> dict[str, Any]:
    force = best_force(experiment, candidates, progress)
    found = run_constant(experiment, [force], progress=False)[0].played
    n = len(found.success)
    figures = {
        "success": share_interval(int(found.success.sum()), n),
        "dropped": share_interval(int(found.dropped.sum()), n),
        "return": mean_interval(found.reward),
    }
    return {"force_N": force, "n": n, **spread(figures)}
