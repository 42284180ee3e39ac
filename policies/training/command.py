"""Turns the arguments of `slipgym train` into what is to be done."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from policies.training import files, folder
from policies.training.config import Training
from slipgym.atomic_io import check_folder
from slipgym.tasks import find


def chosen(name: str | None, options: Mapping[str, Any], texts: Sequence[str]) -> Training:
    """The configuration that a command line names, or its option "task", with what it sets.

    Assignments as texts win over options; an option that is None leaves a value as it is.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: Nothing is named, or a name, key or value is wrong.
    """
    given = {key: value for key, value in options.items() if value is not None}
    if name is None:
        task = given.get("task")
        if task is None:
            raise ValueError(f"name a configuration ({', '.join(files.names())}, or a YAML file) or a --task")
        name = find(task).key
    return files.load(name, {**given, **files.assignments(texts)})


def resumed(path: Path, others: Mapping[str, Any], jobs: int, ray: str) -> Callable[[], str]:
    """The work that continues the run or study of a folder; no other option may be given beside it.

    Raises:
        FileNotFoundError: The folder holds no run.
        ValueError: Another option is given.
    """
    from policies.training import run_set

    for name in (name for name, value in others.items() if value):
        raise ValueError(f"--resume goes on as the run was begun: leave out {name}")
    folder.runs(path)
    return partial(run_set.train_all, path, jobs, ray)


def begun(
    config: Training,
    seeds: Sequence[int],
    sources: Sequence[str],
    trials: int,
    output: Path,
    jobs: int,
    ray: str,
) -> tuple[Path, Callable[[], str]]:
    """The folder of a new study in `output`, or of a sweep if there are `trials`, and what carries it out.

    Without any seed it is 0, without any friction source the configuration's.

    Raises:
        ModuleNotFoundError: Ray is asked for and not installed.
        OSError: The output cannot be written.
        ValueError: A seed or source is wrong, or a sweep has several.
    """
    from policies import parallel
    from policies.training import run_set, sweep

    parallel.check(ray)
    check_folder(output)
    if not trials:
        path = run_set.begin(config, seeds or [0], sources, output)
        return path, partial(run_set.train_all, path, jobs, ray)
    if len(seeds) > 1 or len(sources) > 1:
        raise ValueError("a sweep takes one seed and one friction source")
    for source in sources:
        config = files.changed(config, {"environment.friction_source": source}, "--friction-source")
    path = sweep.begin(config, output)
    return path, partial(sweep.sweep, path, config, trials, *seeds or (0,), jobs, ray)
