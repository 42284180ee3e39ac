"""Measures how learning depends on the seed: the same training with five seeds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from policies.evaluation.statistics import over_seeds
from policies.learned import LearnedPolicy
from policies.policy_leaderboard.entries import Member
from policies.policy_leaderboard.run import WORLDS, play_in
from policies.training import curve, export, files, folder, run_set
from policies.training.config import Training
from slipgym.tasks import find


class Trained(NamedTuple):
    """The policy of one seed, its steps and the seconds of the whole run."""

    policy: Path
    steps: int
    cpu_seconds: float


def trained(name: str, seeds: Sequence[int], root: Path, jobs: int) -> dict[int, Trained]:
    """The policies of a configuration by their seeds; what the folder lacks is trained first.

    Args:
        name: Of a configuration that comes with slipgym.
        seeds: Seeds of the trainings.
        root: Folder of the sets of runs.
        jobs: Runs at once.
    """
    config = files.load(name)
    found = _finished(root, config)
    if missing := [seed for seed in seeds if seed not in found]:
        run_set.train_all(run_set.lay_out([(config, seed) for seed in missing], root), jobs)
        found = _finished(root, config)
    return {seed: found[seed] for seed in seeds}


def _finished(root: Path, wanted: Training) -> dict[int, Trained]:
    """Of the runs with just this configuration, by their seeds."""
    found = {}
    for order in sorted(root.glob("*/*/run.yaml")):
        config, seed = folder.order(order.parent)
        result = folder.result(order.parent)
        if config == wanted and result is not None:
            best = curve.best(folder.read_curve(order.parent), config.evaluation.episodes)
            found[seed] = Trained(order.parent / export.POLICY, best.steps, result["cpu_seconds"])
    return found


def row(name: str, policies: Sequence[Trained], episodes: int) -> dict[str, object]:
    """What the seeds' policies solve in the world of their training, of the same episodes for all [%]."""
    shares = []
    for each in policies:
        policy = LearnedPolicy(each.policy)
        where = policy.description.environment
        own = {key: where.arguments[key] for key in ("friction_source", "sensors", "randomization")}
        member = Member(name, policy, {**own, **policy.modes})
        task, level = find(where.id).name, str(where.arguments["level"])
        shares.append(100.0 * float(play_in(WORLDS[0], task, level, member, episodes, {}).success.mean()))
    mean, low, high = over_seeds(shares)
    cpu = [each.cpu_seconds for each in policies]
    return {
        "configuration": name,
        "seeds": len(shares),
        "solved": mean,
        "low": low,
        "high": high,
        "worst seed": min(shares),
        "best seed": max(shares),
        "million steps": 1e-6 * float(np.median([each.steps for each in policies])),
        "CPU [s]": float(np.median(cpu)),
        "longest [s]": max(cpu),
    }


def table(names: Sequence[str], seeds: Sequence[int], root: Path, jobs: int, episodes: int) -> pd.DataFrame:
    """A row for each configuration; what is a finished run in the folder is not trained again.

    Solved is the interquartile mean over the seeds with its interval; steps are those of the checkpoint
    that a run leaves behind, CPU those of the whole run, as medians.
    """
    rows = []
    for name in names:
        rows.append(row(name, list(trained(name, seeds, root, jobs).values()), episodes))
    return pd.DataFrame(rows)
