"""Stores episodes of a policy as a Minari dataset, for offline learning: `slipgym demonstrate`."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import closing
from importlib import import_module
from typing import Any, NamedTuple

from tqdm import tqdm

from policies.evaluation.one_policy import opened
from policies.stepping import steps


class Stored(NamedTuple):
    """Content of a dataset."""

    episodes: int
    steps: int
    solved: int


def demonstrate(
    which: str | os.PathLike[str],
    dataset: str,
    count: int,
    first: int = 0,
    task: str | None = None,
    changes: Mapping[str, Any] | None = None,
) -> Stored:
    """Plays episodes of a policy and stores them as a dataset; nothing is stored before the last one is over.

    Policy, task and changes are as for `policies.evaluation.one_policy.episodes`; the dataset has a name
    such as "hold/controller-v0"; of the `count` episodes, at least 1, number i has the seed `first` + i.

    Raises:
        ModuleNotFoundError: Minari is not installed.
        FileExistsError: There is a dataset of that name.
        FileNotFoundError, ValueError: As for `episodes`.
    """
    minari: Any = import_module("minari")
    import_module("minari.dataset.minari_dataset").parse_dataset_id(dataset)
    if dataset in minari.list_local_datasets():
        raise FileExistsError(f"there is a dataset {dataset!r}: minari delete {dataset} removes it")
    solved, collector = 0, minari.DataCollector
    with (
        opened(which, task, changes) as (policy, inner),
        closing(collector(inner, record_infos=False)) as env,
    ):
        for seed in tqdm(range(first, first + count), disable=None, leave=False):
            observation, info = env.reset(seed=seed)
            for step in steps(env, policy, observation):
                info = step.info
            solved += bool(info["is_success"])
        made = env.create_dataset(
            dataset,
            eval_env=inner.spec,
            algorithm_name=os.fspath(which),
            author="slipgym",
            author_email="none",
            code_permalink="none",
            description=f"{solved} of {count} episodes solved, seeds from {first} on",
        )
    return Stored(int(made.total_episodes), int(made.total_steps), solved)
