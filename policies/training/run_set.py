"""Several seeds and conditions side by side, each a run of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from policies import parallel
from policies.evaluation.plots.style import STYLE, styled
from policies.training import curve, folder
from policies.training import seeds as numbers
from policies.training.config import Training
from policies.training.files import changed
from policies.training.run import train
from policies.versions import stamped
from slipgym.tasks import find


def begin(config: Training, seeds: Sequence[int], sources: Sequence[str], output: Path) -> Path:
    """Makes a study's folder in `output`, with one for each source (none: the configuration's) and seed.

    Raises:
        ValueError: A source is unknown or a seed out of range.
    """
    for seed in seeds:
        numbers.training(seed)
    conditions = [
        changed(config, {"environment.friction_source": source}, "--friction-source") for source in sources
    ] or [config]
    path = stamped(output, f"{find(config.task).key}__{config.algorithm}")
    for condition in conditions:
        for seed in seeds:
            folder.begin(path / f"{condition.environment.friction_source}__{seed}", condition, seed)
    return path


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
