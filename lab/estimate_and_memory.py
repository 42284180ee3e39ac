"""Measures what an estimate adds to a memory: the same recurrent network, trained alike with and without it.

In both conditions a network imitates the task's controller, which explores with its estimate, and learns on
by PPO with a critic that sees the friction. One of them observes estimates and their deviations as well.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from policies import parallel
from policies.evaluation.play import play_episodes
from policies.evaluation.statistics import Interval, over_seeds
from policies.learned import LearnedPolicy
from policies.training import export, files, folder
from policies.training.imitation.command import configured
from policies.training.imitation.run import POLICY, imitate
from policies.training.run import train

TASK, LEVEL, TRAINING, NETWORK = "Hold", "hard", "hold_memory", "hard_start"
WITHOUT, WITH = "memory", "memory and estimate"
CONDITIONS: dict[str, dict[str, Any]] = {
    WITHOUT: {},
    WITH: {
        "environment.friction_source": "estimated",
        "environment.estimator": "adaptive",
        "environment.observation_mode": "deviations",
    },
}
"""What each network observes -> what differs from the configuration."""
WORLDS: dict[str, dict[str, Any]] = {
    "itself": {},
    "lab": {"sensors": "lab"},
    "eval_ood": {"randomization": "eval_ood"},
    "4 samples late": {"config": {"sensors": {"slip": {"latency_samples": 4}}}},
}
"""Where the policies are evaluated, without learning there -> arguments of the environments."""
AIM = 0.45
"""Solved share of held-out episodes; the steps to the first evaluation with it are counted."""


def table(seeds: Sequence[int], root: Path, jobs: int, episodes: int) -> pd.DataFrame:
    """A row for each condition, and one for what the estimate adds.

    Solved [%] are interquartile means over the seeds, with intervals; the added share is that of pairs of the
    same seed. `start` is the imitation; `steps` are the median of those to the first evaluation with AIM.

    Args:
        seeds: Seeds of the trainings.
        root: Folder of the runs; what it lacks is trained.
        jobs: Runs at once.
        episodes: Of each policy and world; no training used them.
    """
    work = [(name, seed, root) for name in CONDITIONS for seed in seeds]
    runs = dict(zip([each[:2] for each in work], parallel.results(trained, work, jobs), strict=True))
    solved = {key: {"start": first(run), **judged(run, episodes)} for key, run in runs.items()}
    rows = []
    for name in CONDITIONS:
        shares = pd.DataFrame([solved[name, seed] for seed in seeds])
        steps = float(np.median([reached(runs[name, seed]) for seed in seeds]))
        rows.append({"observes": name, "seeds": len(seeds), **spread(shares), "million steps": 1e-6 * steps})
    added = [pd.Series(solved[WITH, seed]) - pd.Series(solved[WITHOUT, seed]) for seed in seeds]
    rows.append({"observes": "added by the estimate", "seeds": len(seeds), **spread(pd.DataFrame(added))})
    return pd.DataFrame(rows)


def spread(shares: pd.DataFrame) -> dict[str, str]:
    """Interquartile means over the rows with intervals, as texts."""
    return {str(name): said(over_seeds(column.tolist())) for name, column in shares.items()}


def said(interval: Interval) -> str:
    """A figure with its interval as a text."""
    text = f"{interval.value:.1f}"
    return text if np.isnan(interval.low) else f"{text} [{interval.low:.1f}, {interval.high:.1f}]"


def trained(name: str, seed: int, root: Path) -> Path:
    """The finished run of a condition and a seed; what is missing of it is done."""
    given: Mapping[str, Any] = CONDITIONS[name]
    where = root / name.replace(" ", "_")
    run = where / f"trained_{seed}"
    if not (run / "run.yaml").exists():
        # an imitation observes what the task's controller does, which has the deviations
        settings = [f"{key}={value}" for key, value in given.items() if not key.endswith("_mode")]
        config = configured(NETWORK, TASK, {}, settings)
        start = where / f"start_{seed}"
        if not list(start.glob(f"*/{POLICY}")):
            imitate(config, start, seed, "slipgym estimate-and-memory")
        (policy,) = start.glob(f"*/{POLICY}")
        folder.begin(run, files.load(TRAINING, {**given, "privileged_ppo.start": str(policy)}), seed)
    train(run, progress=False)
    return run


def first(run: Path) -> float:
    """Held-out episodes that a run's policy solved before it was trained [%]."""
    return 100.0 * folder.read_curve(run)[0].success


def reached(run: Path) -> float:
    """Steps to the first evaluation with AIM; infinite if there is none."""
    return next((row.steps for row in folder.read_curve(run) if row.success >= AIM), np.inf)


def judged(run: Path, episodes: int) -> dict[str, float]:
    """What the best checkpoint of a run solves in each world [%]."""
    policy, source = LearnedPolicy(run / export.POLICY), folder.order(run)[0].environment.friction_source
    found = {}
    for world, given in WORLDS.items():
        made = {**policy.modes, "friction_source": source, "level": LEVEL, **given}
        found[world] = 100.0 * float(play_episodes(TASK, policy, made, range(episodes)).success.mean())
    return found
