"""Measures what an installation of slipgym takes: size and time for each Python and set of extras."""

from __future__ import annotations

import subprocess
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import pandas as pd

ROOT = Path(__file__).resolve().parents[1]
EXTRAS = "", "cli", "records", "eval"
"""The sets of extras; "" is none."""


class Installation(NamedTuple):
    """What an installation took."""

    size: float
    """Of the files that were added [MB]."""
    time: float
    """With downloads [s]."""


def table(pythons: Sequence[str], extras: Sequence[str] = EXTRAS) -> pd.DataFrame:
    """A row for each set of extras; size [MB] and time [s] for each Python.

    Args:
        pythons: Commands of the interpreters, "python3.11".
        extras: Sets of extras of slipgym.

    Raises:
        OSError: There is no such command.
        subprocess.CalledProcessError: An installation fails.
    """
    rows = []
    for extra in extras:
        row: dict[str, object] = {"extra": extra or "none"}
        for python in pythons:
            package = f"{ROOT}[{extra}]" if extra else str(ROOT)
            found = installed(python, ["-c", str(ROOT / "constraints.txt"), package])
            row |= {f"{python} [MB]": found.size, f"{python} [s]": found.time}
        rows.append(row)
    return pd.DataFrame(rows)


def installed(python: str, arguments: Sequence[str]) -> Installation:
    """What `pip install` with some arguments takes in a new virtual environment, without pip's cache."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([python, "-m", "venv", folder], check=True)
        empty, start = size(Path(folder)), time.monotonic()
        own = str(Path(folder) / "bin" / "python")
        pip = [own, "-m", "pip", "install", "--quiet", "--no-cache-dir", "--disable-pip-version-check"]
        subprocess.run([*pip, *arguments], check=True)
        return Installation(size(Path(folder)) - empty, time.monotonic() - start)


def size(folder: Path) -> float:
    """Size of the files of a folder, without links [MB]."""
    files = (each for each in folder.rglob("*") if each.is_file() and not each.is_symlink())
    return 1e-6 * sum(each.stat().st_size for each in files)
