"""Several seeds and conditions side by side, each a run of its own, as `slipgym train` begins them."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from policies import parallel
from policies.evaluation.plots.style import STYLE, styled
from policies.training import curve, folder
from policies.training import model as learners
from policies.training import seeds as numbers
from policies.training.config import Training
from policies.training.files import changed
from policies.training.run import train
from policies.versions import claimed
from slipgym.atomic_io import check_folder
from slipgym.tasks import find


def resumed(path: Path, others: Mapping[str, Any], jobs: int, ray: str) -> Callable[[], str]:
    """The work that continues the run or study of a folder; no other option may be given beside it.

    Raises:
        FileNotFoundError: The folder holds no run.
        ValueError: Another option is given, or the folder is of a sweep.
    """
    for name in (name for name, value in others.items() if value):
        raise ValueError(f"--resume goes on as the run was begun: leave out {name}")
    if (path / folder.SWEEP).exists():
        raise ValueError(f"{path}: a sweep does not go on; --resume {path / 'trial__0'} ends one of its runs")
    folder.runs(path)
    return partial(train_all, path, jobs, ray)


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
    parallel.check(ray)
    check_folder(output)
    if not trials:
        path = begin(config, seeds or [0], sources, output)
        return path, partial(train_all, path, jobs, ray)
    from policies.training import sweep

    if len(seeds) > 1 or len(sources) > 1:
        raise ValueError("a sweep takes one seed and one friction source")
    for source in sources:
        config = changed(config, {"environment.friction_source": source}, "--friction-source")
    _try(sweep.first(config))
    path = sweep.begin(config, output)
    return path, partial(sweep.sweep, path, config, trials, *seeds or (0,), jobs, ray)


def begin(config: Training, seeds: Sequence[int], sources: Sequence[str], output: Path) -> Path:
    """Makes a study's folder in `output`, with one for each source (none: the configuration's) and seed.

    Raises:
        FileNotFoundError: There is no policy to start from.
        ValueError: A source is unknown, a seed out of range or given twice, or the environment does not fit
            the learner.
    """
    if len(set(seeds)) < len(seeds):
        raise ValueError(f"--seeds {' '.join(map(str, seeds))}: each seed only once")
    for seed in seeds:
        numbers.training(seed)
    conditions = [
        changed(config, {"environment.friction_source": source}, "--friction-source") for source in sources
    ] or [config]
    for condition in conditions:
        _try(condition)
    return lay_out([(condition, seed) for condition in conditions for seed in seeds], output)


def lay_out(runs: Sequence[tuple[Training, int]], output: Path) -> Path:
    """Makes a study's folder in `output`, with one for each run of a task: its configuration and seed."""
    first = runs[0][0]
    path = claimed(output, f"{find(first.task).key}__{first.algorithm}")
    for config, seed in runs:
        folder.begin(path / f"{config.environment.friction_source}__{seed}", config, seed)
    return path


def _try(config: Training) -> None:
    """Makes the learner and its environments: what cannot be made is refused before there is a folder."""
    chosen = config.privileged_ppo
    if config.algorithm == "privileged_ppo" and chosen.critic_first and chosen.start is None:
        raise ValueError(
            f"privileged_ppo.critic_first = {chosen.critic_first}: the actor must start as a policy; add "
            "--set privileged_ppo.start=FOLDER (docs/from_nothing.md), or critic_first=0 to do without"
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the run warns
        learner = learners.begin(config.model_copy(update={"processes": False}), 0)
    learner.get_env().close()


def train_all(path: Path, jobs: int = 1, ray: str = "", progress: bool = True) -> str:
    """Trains every run in a folder, or the run it is of, that is not over yet, and draws their curves.

    For `jobs` and `ray` see `policies.parallel.results`. Returns what came out, as text.

    Raises:
        FileNotFoundError: There is no run in the folder.
        ModuleNotFoundError: Ray is asked for and not installed.
    """
    runs = folder.runs(path)
    work = [(run, progress, k) for k, run in enumerate(runs)]
    results = list(parallel.results(train, work, jobs, ray))
    curves: dict[str, list[list[curve.Row]]] = {}
    for run in runs:
        curves.setdefault(run.name.partition("__")[0], []).append(folder.read_curve(run))
    if len(runs) > 1:
        with styled():
            curve.plot(curves).savefig(path / "curves.png", dpi=STYLE.dpi)
    return "\n".join([f"Look at {path}", *map(_said, runs, results)])


def _said(run: Path, result: Mapping[str, Any]) -> str:
    """A line for a run; its best evaluation, that at step 0, may be of a policy that it started from."""
    config, best = folder.order(run)[0], result["best"]
    said = f"  {run.name}: solved {best['success']:.0%} of the held-out episodes at step {best['steps']}"
    if config.algorithm == "privileged_ppo" and config.privileged_ppo.start and not best["steps"]:
        said += ": the policy that it started from solves as many"
    said += f"; ended by {result['ended']} at step {result['steps']} after {result['seconds']:.0f} s"
    if "cpu_seconds" in result:  # runs of slipgym 0.1.0 do not know it
        said += f", {result['cpu_seconds']:.0f} s of CPU"
    return said if result["steps"] else f"{said}; nothing was learned"
