"""Compares pretrained policies with controllers and the best constant grip, at the same rate of action.

The benefit of knowing friction is measured against policies without friction information: each changes what a
conservative controller does, which has no memory of earlier episodes. Another baseline gives another benefit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from policies.evaluation.constant_grip import best_force
from policies.evaluation.experiment import Experiment
from policies.evaluation.files import load_experiment
from policies.evaluation.frames import groups, values
from policies.evaluation.plan import plan
from policies.evaluation.rate import common_frame_skip
from policies.evaluation.statistics import Interval, mean_interval, share_interval
from policies.evaluation.trial import run_trials
from policies.learned import pretrained
from slipgym.config.yaml_model import validate
from slipgym.registration import TASK_MODULES
from slipgym.tasks import find

SOURCES = ("estimated", "true", "none")
CONTROLLER, LEARNED, CONSTANT = "controller", "learned", "constant grip"
_OUTCOMES = {"success": "success [%]", "return": "sum of rewards", "mean_force_N": "grip force [N]"}


def learned_tasks() -> list[str]:
    """Keys of the tasks that have learned policies."""
    keys = [find(task).key for task in TASK_MODULES]
    return [key for key in keys if any(f"{key}_{source}" in pretrained.folders() for source in SOURCES)]


def trials_of(
    task: str,
    trials: int = 200,
    engine: str = "bullet",
    randomization: str | Mapping[str, Any] = "train",
    jobs: int = 1,
    progress: bool = True,
) -> pd.DataFrame:
    """The controller and the learned policies of a task in the same episodes.

    Args:
        task: As `slipgym.tasks.find` takes it; the experiment "<its key>_train" says which episodes.
        trials: Episodes, spread evenly over the experiment's combinations of options.
        engine: What moves the bodies.
        randomization: What is drawn per episode.
        jobs: Processes.
        progress: Whether to show a progress bar.

    Returns:
        A row per trial, as in an experiment's table; the column "policy" has CONTROLLER, LEARNED, or CONSTANT
        with its force. All act at the rate of the learned policies. The best constant grip is chosen on other
        episodes (`policies.evaluation.constant_grip`).

    Raises:
        ValueError: The task, or a value, is unknown, the task has no learned policies, or these act at
            different rates.
    """
    key = find(task).key
    if key not in learned_tasks():
        raise ValueError(f"{key} has no learned policies; tasks that have: {', '.join(learned_tasks())}")
    base = load_experiment(f"{key}_train")
    per_condition = -(-trials // len(base.combinations()))
    names = {source: f"{key}_{source}" for source in SOURCES if f"{key}_{source}" in pretrained.folders()}
    learned = [({"name": name, "label": LEARNED}, (source,)) for source, name in names.items()]
    skip = common_frame_skip(names.values())
    selection = base.model_copy(update={"trials": per_condition, "randomization": randomization})
    force = best_force(selection, progress=progress)
    constant = {"name": "constant_force", "parameters": {"force": force}, "label": f"{CONSTANT}, {force:g} N"}
    known = ({"name": key, "label": CONTROLLER}, ("estimated", "true"))
    rows = []
    for policy, sources in (known, *learned, (constant, ("none",))):
        given = {
            **base.model_dump(exclude_unset=True),
            "policies": [policy],
            "friction": [{"source": source} for source in sources],
            "trials": per_condition,
            "frame_skip": skip,
            "engine": engine,
            "randomization": randomization,
        }
        experiment = validate(given, Experiment, key)
        rows += [result.row for result in run_trials(experiment, plan(experiment), jobs, progress)]
    return pd.DataFrame(rows)


def outcomes(trials: pd.DataFrame) -> pd.DataFrame:
    """Share of solved episodes, sum of rewards and grip force of each policy, with 95 % intervals.

    Args:
        trials: From `trials_of`.
    """
    rows = []
    for (policy, source), group in groups(trials, ["policy", "friction"]):
        row = {"policy": policy, "friction": source, "episodes": len(group)}
        for column, heading in _OUTCOMES.items():
            found = values(group, column).astype(np.float64)
            if column == "success":
                interval = Interval(*(100.0 * v for v in share_interval(int(found.sum()), len(found))))
            else:
                interval = mean_interval(found)
            row[heading] = text(interval)
        rows.append({**row, "dropped [%]": f"{100.0 * group['dropped'].mean():.1f}"})
    return pd.DataFrame(rows)


def gains(trials: pd.DataFrame) -> pd.DataFrame:
    """Differences of the learned policies to the controller with the same friction information, over pairs.

    Args:
        trials: From `trials_of`.

    Returns:
        For success [%] and the sum of rewards: mean difference with its 95 % interval, per friction source.
    """
    rows = []
    for column, scale in (("success", 100.0), ("return", 1.0)):
        tables = {
            policy: trials[trials["policy"] == policy].pivot(
                index=["options", "trial"], columns="friction", values=column
            )
            for policy in (CONTROLLER, LEARNED)
        }
        both = [source for source in SOURCES if all(source in table for table in tables.values())]
        found = {
            source: scale * (tables[LEARNED][source].astype(float) - tables[CONTROLLER][source].astype(float))
            for source in both
        }
        row = {source: text(mean_interval(difference.to_numpy())) for source, difference in found.items()}
        rows.append({"learned - controller": _OUTCOMES[column], **row})
    return pd.DataFrame(rows)


def benefit(trials: pd.DataFrame) -> pd.DataFrame:
    """The benefit of knowing friction to the learned policies, over paired episodes.

    Args:
        trials: From `trials_of`.

    Returns:
        Nothing unless there are learned policies of all three sources. Else,
        for success [%] and the sum of rewards: the difference of the policy with true friction to the one
        without friction information, that of the policy with estimates, and the latter over the former;
        no share where the former's 95 % interval holds 0.
    """
    learned = trials[trials["policy"] == LEARNED]
    if not set(SOURCES) <= set(learned["friction"]):
        return pd.DataFrame()
    rows = []
    for column, scale in (("success", 100.0), ("return", 1.0)):
        table = learned.pivot(index=["options", "trial"], columns="friction", values=column).astype(float)
        table = scale * table
        full, part = (table[source] - table["none"] for source in ("true", "estimated"))
        whole = mean_interval(full.to_numpy())
        share = part.mean() / whole.value if whole.low > 0.0 else None
        rows.append(
            {
                "measure": _OUTCOMES[column],
                "true - none": text(whole),
                "estimated - none": text(mean_interval(part.to_numpy())),
                "share [%]": "-" if share is None else f"{100.0 * share:.0f}",
            }
        )
    return pd.DataFrame(rows)


def text(interval: Sequence[float]) -> str:
    """Value, low and high as words."""
    value, low, high = interval
    return f"{value:.1f} ({low:.1f} to {high:.1f})"
