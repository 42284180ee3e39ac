"""Runs the conditions of a study that are not there yet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pandas as pd
from tqdm import tqdm

from policies import parallel
from policies.evaluation.plan import plan
from policies.evaluation.trial import pieces, run_block
from policies.study.conditions import Condition
from policies.study.config import Study
from policies.study.store import Store

COLUMNS = ["seed", "success", "dropped", "return", "steps", "mean_force_N", "final_mu_c", "true_mu_c"]
"""What is kept of an episode of any task, besides the keys of its condition and its number."""


def episodes(
    study: Study, conditions: Sequence[Condition], store: Store, jobs: int = 1, progress: bool = True
) -> pd.DataFrame:
    """The episodes of all conditions; those that are not in the store are run and kept there, one by one.

    The results do not depend on the number of processes, -1 for one per core.

    Raises:
        ValueError: A policy refuses the observations.
        OSError: The store cannot be written.
    """
    pending = [condition for condition in conditions if not store.has(condition)]
    experiments = [condition.experiment(study) for condition in pending]
    planned = [(condition, each, plan(each)) for condition, each in zip(pending, experiments, strict=True)]
    work = [(each, piece) for _, each, trials in planned for piece in pieces(each, trials)]
    results = parallel.results(run_block, work, jobs)
    total = sum(len(trials) for _, _, trials in planned)
    with tqdm(total=total, desc=study.name, unit="episode", disable=not progress) as bar:
        for condition, _, trials in planned:
            rows: list[dict[str, Any]] = []
            while len(rows) < len(trials):
                for result in next(results):
                    kept = {name: result.row[name] for name in COLUMNS}
                    rows.append({**condition.keys, "episode": len(rows), **kept})
                    bar.update()
            store.write(condition, pd.DataFrame(rows))
    return pd.concat([store.read(condition) for condition in conditions], ignore_index=True)
