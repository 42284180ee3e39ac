"""Learned policies by the task and the friction source they were trained with."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

from policies.learned import pretrained
from policies.learned.files import DESCRIPTION
from policies.study.config import SOURCES, Study
from slipgym.tasks import find

TRAINED_WITH: dict[str, str] = {source: source for source in SOURCES} | {"nominal": "true"}
"""Friction source of an evaluation -> that of the training; nobody trains on wrong values on purpose."""

Shelf = dict[tuple[str, str, str], dict[int, Path]]
"""(kind, task, source) -> seed -> folder."""


def policies_of(study: Study) -> Shelf:
    """The learned policies of a study, by kind, task and friction source of the training; by seed within.

    A policy lies in a folder <task>_<source> or <task>_<source>_<seed>, as in "linear_slip_true_2"; without a
    number it is seed 0. Or it is one of those that `slipgym train` or `slipgym imitate` left in the folder.
    Of those that come with slipgym, <task>_scratch is for the source "true", and for "none" <task>_memory, or
    <task>_lab if the study has the sensors "lab".

    Raises:
        ValueError: Two folders stand for the same seed.
    """
    endings: dict[str, str] = {source: source for source in SOURCES}
    endings |= {"scratch": "true", "lab" if study.sensors == "lab" else "memory": "none"}
    found: Shelf = {}
    for kind, where in folders(study).items():
        for folder, name in _named(where):
            for task, (ending, source) in itertools.product(study.tasks, endings.items()):
                match = re.fullmatch(rf"{find(task).key}_{ending}(?:_+(\d+))?", name)
                if match is None:
                    continue
                seeds, seed = found.setdefault((kind, task, source), {}), int(match[1] or 0)
                if seed in seeds:
                    raise ValueError(f"{folder} and {seeds[seed]} are both seed {seed}")
                seeds[seed] = folder
    return found


def folders(study: Study) -> dict[str, Path]:
    """Kind of learned policy -> folder of its policies, of the kinds that have one."""
    given = {"learned": study.learned or str(pretrained.FOLDER), "imitation": study.imitation}
    return {kind: Path(folder) for kind, folder in given.items() if folder and kind in study.kinds}


def _named(top: Path) -> list[tuple[Path, str]]:
    """Folders of policies, and what they are called."""
    named = {path.parent: path.parent.name for path in top.glob(f"*/{DESCRIPTION}")}
    for path in top.glob(f"*/policy/{DESCRIPTION}"):
        named[path.parent] = path.parents[1].name
    for path in top.glob(f"*__*/*__*/policy/{DESCRIPTION}"):
        key, _, _ = path.parents[2].name.partition("__")
        named[path.parent] = f"{key}_{path.parents[1].name}"
    return sorted(named.items())


def missing(study: Study, found: Shelf) -> list[str]:
    """In words, the policies that a study would need and that are not there.

    Of imitations it needs those that see sensors alone.
    """
    lacking = []
    for kind, place in folders(study).items():
        wanted = ("none",) if kind == "imitation" else SOURCES
        for task in study.tasks:
            sources = [source for source in wanted if (kind, task, TRAINED_WITH[source]) not in found]
            if sources:
                where = "the policies that come with slipgym" if place == pretrained.FOLDER else place
                looked = f"looked for {find(task).key}_<source> in {where}"
                lacking.append(f"{task}: no policy of kind {kind} for {', '.join(sources)}; {looked}")
    return lacking
