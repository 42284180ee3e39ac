"""Learned policies by the task and the friction source they were trained with."""

from __future__ import annotations

import os
import re
from pathlib import Path

from policies.learned import pretrained
from policies.learned.files import DESCRIPTION
from policies.research.study.config import SOURCES, Study
from slipgym.tasks import find

TRAINED_WITH: dict[str, str] = {source: source for source in SOURCES} | {"nominal": "true"}
"""Friction source of an evaluation -> that of the training; nobody trains on wrong values on purpose."""


def policies_of(study: Study) -> dict[tuple[str, str], list[Path]]:
    """The policies of a study, by task and friction source of the training; by seed within.

    A policy lies in a folder <task>_<source> or <task>_<source>_<seed>, as in "linear_slip_true_2"; without a
    number it is seed 0. Or it is one of those that scripts/train.py left in the folder.

    Raises:
        ValueError: Two folders stand for the same seed.
    """
    top = Path(study.learned) if study.learned else pretrained.FOLDER
    named = {path.parent: path.parent.name for path in top.glob(f"*/{DESCRIPTION}")}
    for path in top.glob(f"*__*/*__*/policy/{DESCRIPTION}"):
        key, _, _ = path.parents[2].name.partition("__")
        named[path.parent] = f"{key}_{path.parents[1].name}"
    found: dict[tuple[str, str], dict[int, Path]] = {}
    for folder, name in sorted(named.items()):
        for task in study.tasks:
            for source in SOURCES:
                match = re.fullmatch(rf"{find(task).key}_{source}(?:_+(\d+))?", name)
                if match is None:
                    continue
                seeds = found.setdefault((task, source), {})
                seed = int(match[1] or 0)
                if seed in seeds:
                    raise ValueError(f"{folder} and {seeds[seed]} are both seed {seed}")
                seeds[seed] = folder
    return {key: [seeds[seed] for seed in sorted(seeds)] for key, seeds in found.items()}


def missing(study: Study, found: dict[tuple[str, str], list[Path]]) -> list[str]:
    """In words, the policies that a study would need and that are not there."""
    if "learned" not in study.kinds:
        return []
    lacking = []
    for task in study.tasks:
        sources = [source for source in SOURCES if (task, TRAINED_WITH[source]) not in found]
        if sources:
            lacking.append(
                f"{task}: no learned policy for {', '.join(sources)}; looked for {find(task).key}_<source> "
                f"in {os.fspath(study.learned) or 'the policies that come with slipgym'}"
            )
    return lacking
