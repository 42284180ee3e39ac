"""Turns the arguments of `slipgym imitate` into what is to be done."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from policies.training.files import assignments, with_values
from policies.training.imitation.config import Imitation, read
from policies.training.imitation.episodes import arguments
from slipgym.config.yaml_model import validate


def configured(network: str, task: str, given: Mapping[str, Any], texts: Sequence[str]) -> Imitation:
    """The imitation that a command line names, with what it sets.

    Assignments as texts win over given arguments of the environment; None leaves one of these as it is.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: A name, key or value is wrong, or the controller needs another mode.
    """
    base = {"environment": {"friction_source": "none", "frame_skip": 2}}
    base |= read(network).model_dump(exclude_unset=True)
    environment = {f"environment.{name}": value for name, value in given.items() if value is not None}
    values = with_values({**base, "task": task}, {**environment, **assignments(texts)})
    config = validate(values, Imitation, "command line")
    arguments(config)
    return config


def imitated(config: Imitation, seeds: Sequence[int], output: Path) -> Iterator[str]:
    """Carries out an imitation with each seed; says where each is and how good it is.

    Raises:
        FloatingPointError: A loss is not finite.
        OSError: The output cannot be written, or a run's folder is there already.
    """
    from policies.training.imitation.run import UNFINISHED, destination, imitate

    folders = [destination(config, output, seed) for seed in seeds]
    yield f"If it is interrupted, the last round's policy is in {folders[0].parent / '*' / UNFINISHED}"
    for seed in seeds:
        folder, solved = imitate(config, output, seed, shlex.join(sys.argv))
        yield f"{folder / 'policy'}: solves {solved:.1%} of {config.held_out} held-out episodes"
