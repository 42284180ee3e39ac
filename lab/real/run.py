"""Writes what surfaces, estimators and their slip decision say of the real data, as one page."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import pandas as pd

from lab import pushes
from lab.real import silicone, tugs
from policies.data.sets import SETS
from policies.evaluation.frames import markdown
from slipgym import atomic_io

LICENCES = "the licence's text is in LICENSES.txt"


def table(
    name: str, extract: Path, reduced: Callable[[Path], pd.DataFrame], data: Path | None
) -> pd.DataFrame:
    """The reduced rows of a set.

    Args:
        name: Of the set.
        extract: Its extract, taken if `data` is None.
        reduced: Reads a folder of the set.
        data: Folder that `slipgym data` made.

    Raises:
        ValueError: A file is missing or another one.
        OSError: The extract cannot be read.
    """
    return pd.read_csv(extract, comment="#") if data is None else reduced(data / name)


def page(data: Path | None, number: int, seed: int) -> str:
    """The tables of all sets, as Markdown; `number` resamples of a `seed`, the rest as `table`."""
    friction = table("silicone", silicone.EXTRACT, silicone.reduced, data)
    grasps = table("tugs", tugs.EXTRACT, tugs.reduced, data)
    logs = pushes.read(pushes.EXTRACT if data is None else data / "pushes")
    parts = [
        "# Silicone on PLA: exponent of the load",
        markdown(silicone.exponents(friction, number, seed), 1),
        "# Tugged grasps: is the largest score of a record that of a tug?",
        f"{int(grasps['tugged'].to_numpy(int).sum())} of {len(grasps)} records are tugged.",
        markdown(tugs.areas(grasps, number, seed)),
        "# Pushes of a block",
        pushes.run_pushes(logs, number, seed),
    ]
    return "\n\n".join(part.rstrip() for part in parts) + "\n"


def write_extracts(data: Path) -> None:
    """Writes the extracts that lie beside this file, with source and licence in their heads.

    Raises:
        ValueError: A file is missing or another one.
        OSError: An extract cannot be written.
    """
    for name, module in (("silicone", silicone), ("tugs", tugs)):
        public, text = SETS[name], io.StringIO()
        text.write(f"# Extract of {public.url}, commit {public.commit}; {public.licence}, {LICENCES}.\n")
        text.write(f"# Changed: reduced by lab/real/{name}.py of slipgym, which says how.\n")
        module.reduced(data / name).to_csv(text, index=False, float_format="%.7g", lineterminator="\n")
        atomic_io.write(module.EXTRACT, text.getvalue().encode("utf-8"))
    pushes.write(pushes.read(data / "pushes"), pushes.EXTRACT)
