"""From finished studies to the policies that come with slipgym, and the pages that show how they learned."""

from __future__ import annotations

import csv
import io
import shutil
from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import NamedTuple

from policies.evaluation.plots.style import STYLE, styled
from policies.learned import files as policy_files
from policies.learned.pretrained import FOLDER
from policies.training import curve, export, files, folder
from policies.training.curve import Row
from slipgym.atomic_io import check_folder
from slipgym.tasks import find

CURVES = Path("docs") / "learned"
"""Where the curves of all seeds go, beside a picture of them."""


class Run(NamedTuple):
    """A finished run of a configuration that comes with slipgym."""

    key: str
    """Its configuration's name: the task's key, or that with "_scratch"."""
    source: str
    """Its friction information in training."""
    seed: int
    curve: list[Row]
    episodes: int
    """Episodes of an evaluation."""
    policy: Path
    """The folder of its policy."""

    @property
    def name(self) -> str:
        """What its policy is called; the configurations from nothing observe the true friction."""
        own = self.key.endswith("_scratch") and self.source == "true"
        return self.key if own else f"{self.key}_{self.source}"

    @property
    def command(self) -> str:
        """What trains it again."""
        return f"python scripts/train.py {self.key} --friction-source {self.source} --seeds {self.seed}"

    @property
    def best(self) -> Row:
        """Its best evaluation, which its policy is of."""
        return curve.best(self.curve, self.episodes)


def ship(studies: Sequence[Path], target: Path = FOLDER, pages: Path = CURVES) -> list[Path]:
    """Adds the best seed of each task and friction source to the pretrained ones, all curves to the pages.

    Policies and curves of the same tasks and sources give way.

    Args:
        studies: Folders of finished studies or runs.
        target: Folder for the policies.
        pages: Folder for the curves, a table and a picture for each task.

    Returns:
        The folders of the policies.

    Raises:
        FileNotFoundError: A folder holds no run.
        OSError: A folder cannot be written to.
        ValueError: A run is not finished, or not one of the configuration that its task has.
    """
    found = [_finished(path) for study in studies for path in folder.runs(study)]
    for each in (target, pages):
        check_folder(each)
    pages.mkdir(parents=True, exist_ok=True)
    shipped = []
    for key in sorted({run.key for run in found}):
        runs = sorted(run for run in found if run.key == key)
        conditions = {run.source: [other for other in runs if other.source == run.source] for run in runs}
        shipped += [_put(_best(same), target) for same in conditions.values()]
        (pages / f"{key}.csv").write_text(_table(runs), encoding="utf-8")
        with styled():
            curves = {source: [run.curve for run in same] for source, same in conditions.items()}
            curve.plot(curves).savefig(pages / f"{key}.png", dpi=STYLE.dpi)
    return shipped


def _best(seeds: Sequence[Run]) -> Run:
    """The seed whose best evaluation is the best of all of them."""
    ends = [run.best for run in seeds]
    return seeds[ends.index(curve.best(ends, seeds[0].episodes))]


def _finished(path: Path) -> Run:
    config, seed = folder.order(path)
    if folder.result(path) is None:
        raise ValueError(f"{path} is not finished")
    key, source = find(config.task).key, config.environment.friction_source
    given = {"environment.friction_source": source}
    if config.algorithm == "privileged_ppo":
        key += "_scratch"
    if config != files.load(key, given):
        raise ValueError(f"{path} was not trained as configs/training/{key}.yaml says")
    return Run(key, source, seed, folder.read_curve(path), config.evaluation.episodes, path / export.POLICY)


def _put(run: Run, target: Path) -> Path:
    """The policy without what only training needs."""
    description, weights = policy_files.read(run.policy)
    values = description.model_dump(mode="json", exclude={"format", "files"})
    values["origin"] |= {"command": run.command, "steps": run.best.steps, "critic": None}
    del values["origin"]["versions"]["platform"]  # of the machine that trained it
    path = target / run.name
    if path.exists():
        shutil.rmtree(path)
    return policy_files.write(path, values, weights)


def _table(runs: Sequence[Run]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(
        text, ["source", "seed", *(field.name for field in fields(Row))], lineterminator="\n"
    )
    writer.writeheader()
    for run in runs:
        writer.writerows({"source": run.source, "seed": run.seed, **asdict(row)} for row in run.curve)
    return text.getvalue()
