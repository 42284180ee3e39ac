"""The extract of the logs: a row of means for each push, as a table in text."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lab.pushes.logs import parse, read_log, reduced
from lab.pushes.sources import COMMIT, FOLDER, HELD_OUT, LOGS, REPOSITORY
from slipgym import atomic_io

EXTRACT = Path(__file__).with_name("pushes.csv")
"""Where the extract is looked for if no other place is given."""
COLUMNS = ("f_x", "f_y", "tau", "d_x", "d_y", "d_theta", "yaw", "x", "y", "duration")
"""What `lab.pushes.logs.reduced` returns."""
ORIGIN = f"""\
# Extract of {REPOSITORY}, commit {COMMIT}, {FOLDER}.
# Copyright of the logs: the authors of {REPOSITORY}; Apache License, Version 2.0,
# http://www.apache.org/licenses/LICENSE-2.0. Changed: every push is reduced to means and one displacement,
# by lab/pushes/logs.py of slipgym, which describes the frames. Units: N, N m, m, rad, s.
"""


@dataclass(frozen=True)
class Pushes:
    """The pushes of a log."""

    name: str
    """A key of `LOGS` or `HELD_OUT`: surface, support, and the file if it is held out."""
    values: np.ndarray
    """`COLUMNS`, (n, 10)."""

    @property
    def support(self) -> str:
        """The support's name in `lab.pushes.support`."""
        return self.name.split(", ")[1]

    @property
    def wrench(self) -> np.ndarray:
        """Mean (f_x, f_y, tau) of the pusher on the block, (n, 3) [N, N, N m]."""
        return self.values[:, :3]

    @property
    def displacement(self) -> np.ndarray:
        """(d_x, d_y, d_theta) of the block, (n, 3) [m, m, rad]."""
        return self.values[:, 3:6]

    @property
    def yaw(self) -> np.ndarray:
        """Of the block half way, (n,) [rad]."""
        return self.values[:, 6]

    def chosen(self, index: np.ndarray) -> Pushes:
        """Some of the pushes."""
        return Pushes(self.name, self.values[index])


def read(source: Path = EXTRACT) -> list[Pushes]:
    """The pushes of all logs.

    Args:
        source: Folder of a clone of the repository, or an extract that `write` made.

    Raises:
        ValueError: There is nothing at `source`, a log is not the known one, or the extract is not whole.
        OSError: A file cannot be read.
    """
    if source.is_dir():
        return [reduced_log(source, name) for name in LOGS]
    if not source.is_file():
        raise ValueError(
            f"no extract at {source}: clone https://{REPOSITORY}, check out {COMMIT[:7]} and give its folder"
        )
    lines = [line for line in source.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    if not rows or set(rows[0]) != {"log", *COLUMNS} or {row["log"] for row in rows} != set(LOGS):
        raise ValueError(
            f"{source} is not an extract: expected columns log, {', '.join(COLUMNS)} and all logs"
        )
    return [
        Pushes(
            name, np.array([[float(row[column]) for column in COLUMNS] for row in rows if row["log"] == name])
        )
        for name in LOGS
    ]


def reduced_log(clone: Path, name: str) -> Pushes:
    """The pushes of one log of a clone; arguments and errors as `read_log`, or the log has another form."""
    return Pushes(name, np.array([reduced(push) for push in parse(read_log(clone, name))]))


def read_held_out(clone: Path) -> tuple[list[Pushes], dict[str, str]]:
    """The pushes of the smaller logs of a clone, and why the others cannot be read.

    Raises:
        OSError: A file cannot be read.
    """
    found, failed = [], {}
    for name in HELD_OUT:
        try:
            found.append(reduced_log(clone, name))
        except ValueError as error:
            failed[name] = str(error)
    return found, failed


def write(pushes: list[Pushes], path: Path) -> None:
    """Writes an extract, with its source and licence in its head.

    Raises:
        OSError: It cannot be written.
    """
    text = io.StringIO()
    text.write(ORIGIN)
    table = csv.writer(text, lineterminator="\n")
    table.writerow(("log", *COLUMNS))
    for log in pushes:
        table.writerows([log.name, *(f"{value:.7g}" for value in row)] for row in log.values)
    atomic_io.write(path, text.getvalue().encode("utf-8"))
