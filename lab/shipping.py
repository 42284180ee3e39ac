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

    name: str
    """Its configuration's name, which its policy goes by: "carry_scratch" for example."""
    source: str
    """Its friction information in training."""
    seed: int
    curve: list[Row]
    episodes: int
    """Episodes of an evaluation."""
    policy: Path
    """The folder of its policy."""
    start: str | None
    """The folder of the policy that it began as."""
    cpu_seconds: float | None
    """Time of the processor that it took; None: not known [s]."""

    @property
    def command(self) -> str:
        """What trains it again; of the start only the run's own folder, as the others are one machine's."""
        said = f"python scripts/train.py {self.name} --friction-source {self.source} --seeds {self.seed}"
        start = "/".join(Path(self.start).parts[-2:]) if self.start else ""
        return f"{said} --set privileged_ppo.start={start}" if start else said

    @property
    def best(self) -> Row:
        """Its best evaluation, which its policy is of."""
        return curve.best(self.curve, self.episodes)


def ship(
    studies: Sequence[Path], name: str | None = None, target: Path = FOLDER, pages: Path = CURVES
) -> list[Path]:
    """Adds the best seed of each configuration to the pretrained ones, all curves to the pages.

    Policies and curves of the same name give way.

    Args:
        studies: Folders of finished studies or runs.
        name: Configuration that they were trained as; None: the one that the task's name stands for.
        target: Folder for the policies.
        pages: Folder for the curves, a table and a picture for each name.

    Returns:
        The folders of the policies.

    Raises:
        FileNotFoundError: A folder holds no run.
        OSError: A folder cannot be written to.
        ValueError: A run is not finished, or not one of the configuration.
    """
    found = [_finished(path, name) for study in studies for path in folder.runs(study)]
    for each in (target, pages):
        check_folder(each)
    pages.mkdir(parents=True, exist_ok=True)
    shipped = []
    for each in sorted({run.name for run in found}):
        runs = sorted(run for run in found if run.name == each)
        shipped.append(_put(_best(runs), target))
        (pages / f"{each}.csv").write_text(_table(runs), encoding="utf-8")
        with styled():
            curves = {runs[0].source: [run.curve for run in runs]}
            curve.plot(curves).savefig(pages / f"{each}.png", dpi=STYLE.dpi)
    return shipped


def _best(seeds: Sequence[Run]) -> Run:
    """The seed whose best evaluation is the best of all of them."""
    ends = [run.best for run in seeds]
    return seeds[ends.index(curve.best(ends, seeds[0].episodes))]


def _finished(path: Path, name: str | None) -> Run:
    config, seed = folder.order(path)
    result = folder.result(path)
    if result is None:
        raise ValueError(f"{path} is not finished")
    name = name or find(config.task).key + files.OWN
    start = config.privileged_ppo.start
    wanted = files.load(name, {"privileged_ppo.start": start})
    has, needs = config.model_dump(), wanted.model_dump()
    if other := [key for key in needs if has[key] != needs[key]]:
        raise ValueError(
            f"{path} was not trained as configs/training/{name}.yaml says: {', '.join(other)} differ"
        )
    source, episodes = config.environment.friction_source, config.evaluation.episodes
    return Run(
        name,
        source,
        seed,
        folder.read_curve(path),
        episodes,
        path / export.POLICY,
        start,
        result.get("cpu_seconds"),
    )


def _put(run: Run, target: Path) -> Path:
    """The policy without what only training needs."""
    description, weights = policy_files.read(run.policy)
    values = description.model_dump(mode="json", exclude={"format", "files"})
    values["origin"] |= {"command": run.command, "steps": run.best.steps, "critic": None}
    values["origin"]["cpu_seconds"] = run.cpu_seconds and round(run.cpu_seconds, 1)
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
