"""Reads the declarations of the results from results.yaml."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from estimator.suggestions import unknown

FILE = Path(__file__).with_name("results.yaml")


class Result(NamedTuple):
    """A file of docs/results and the commands that print its content."""

    name: str
    """Name of the file, without suffix."""
    question: str
    """Title of the file."""
    commands: tuple[str, ...]
    """Command lines without `slipgym`; the outputs follow one another in the file."""
    page: str
    """Page in docs/ that shows it."""
    minutes: float
    """Expected time on two cores [min]."""
    begins: str = ""
    """Start of the first line that is kept of an output; empty: all lines are kept."""
    keep: tuple[str, ...] = ()
    """Titles of the sections that are kept of an output; empty: all sections are kept."""
    pictures: dict[str, str] = {}  # noqa: RUF012
    """Name of a picture in the run's folder -> its name in docs/images."""
    needs: str = ""
    """File or folder of the clone without which the commands cannot run; empty: none is needed."""

    @property
    def arguments(self) -> list[list[str]]:
        """Arguments of each command: the sub-command and its options."""
        return [shlex.split(command) for command in self.commands]


def read(path: Path = FILE) -> list[Result]:
    """The declared results in their order.

    Args:
        path: YAML file; its first lines explain the keys.

    Raises:
        ValueError: A key is unknown or missing.
    """
    found = []
    for name, entry in yaml.safe_load(path.read_text(encoding="utf-8")).items():
        values: dict[str, Any] = dict(entry)
        commands = values.pop("command", [])
        values["commands"] = (commands,) if isinstance(commands, str) else tuple(commands)
        values["keep"] = tuple(values.get("keep", ()))
        try:
            found.append(Result(name, **values))
        except TypeError as error:
            raise ValueError(f"{path.name}: {name}: {error}") from error
    return found


def find(names: Sequence[str]) -> list[Result]:
    """The results with these names in their order; all if none is named.

    Raises:
        ValueError: A name is unknown.
    """
    known = {result.name: result for result in RESULTS}
    for name in names:
        if name not in known:
            raise ValueError(unknown("unknown result", name, known))
    return [known[name] for name in names] or RESULTS


RESULTS = read()
"""Every result, in the order of `make results`."""
