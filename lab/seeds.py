"""Measures how learning depends on the seed: the same training with five seeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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

PASSES = {
    "carry_lab": ("carry_lab_start", "carry_lab"),
    "hold_lab": ("hold_lab_start", "hold_lab", "hold_lab"),
}
"""Configurations that a seed goes through, each from the result of the one before; docs/from_nothing.md."""


class Trained(NamedTuple):
    """The policy of one seed; steps and seconds are of all its passes."""

    policy: Path
    steps: int
    cpu_seconds: float


def trained(name: str, seeds: Sequence[int], root: Path, jobs: int) -> dict[int, Trained]:
    """The policies of a configuration by their seeds; what the folder lacks is trained first.

    Args:
        name: Of a configuration that comes with slipgym.
        seeds: Seeds of the trainings, in every pass.
        root: Folder of the sets of runs.
        jobs: Runs at once.
    """
    found: dict[int, Trained] = {}
    for one in PASSES.get(name, (name,)):
        found = _after(found, files.load(one), seeds, root, jobs)
    return found


def _after(
    before: Mapping[int, Trained], config: Training, seeds: Sequence[int], root: Path, jobs: int
) -> dict[int, Trained]:
    """One pass of each seed, on from its policy before."""
    wanted = dict.fromkeys(seeds, config)
    for seed, start in before.items():
        wanted[seed] = files.changed(config, {"privileged_ppo.start": str(start.policy.resolve())})
    found = _finished(root, wanted)
    if missing := [seed for seed in seeds if seed not in found]:
        run_set.train_all(run_set.lay_out([(wanted[seed], seed) for seed in missing], root), jobs)
        found = _finished(root, wanted)
    nothing = Trained(Path(), 0, 0.0)
    return {seed: _sum(before.get(seed, nothing), found[seed]) for seed in seeds}


def _sum(before: Trained, last: Trained) -> Trained:
    return Trained(last.policy, before.steps + last.steps, before.cpu_seconds + last.cpu_seconds)


def _finished(root: Path, wanted: Mapping[int, Training]) -> dict[int, Trained]:
    """Of the runs with just the configuration of their seed."""
    found = {}
    for order in sorted(root.glob("*/*/run.yaml")):
        config, seed = folder.order(order.parent)
        result = folder.result(order.parent)
        if config == wanted.get(seed) and result is not None:
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
