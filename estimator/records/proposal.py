"""Shows a proposed mapping as YAML, as a table and as a picture, and tries it on the record."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from estimator.records.alignment import align
from estimator.records.columns import parse_columns
from estimator.records.extras import extra
from estimator.records.faults import fault_warnings
from estimator.records.reading import load
from estimator.records.readings import reading_warnings
from estimator.records.record import Array
from estimator.records.table import listed
from estimator.records.units import units_of


@dataclass(frozen=True)
class Proposed:
    """What a column may be."""

    key: str
    """Key of a mapping."""
    column: str
    """Its name."""
    unit: str
    """Its unit; empty for dates, which need none."""
    sign: int
    """1 or -1."""
    position: bool
    """Whether it counts displacement."""
    why: str
    """Where the unit comes from: said by the file, or guessed."""
    values: Array = field(repr=False)
    """In SI and slipgym's sign, (n,), NaN where there is none."""


@dataclass(frozen=True)
class Proposal:
    """A proposed mapping."""

    fingers: Mapping[str, Sequence[Proposed]]
    """Name of a finger, empty if there is one, -> its columns."""
    missing: Sequence[str]
    """Required keys for which no column was found."""
    rest: Sequence[str]
    """Columns that are not used."""

    def text(self) -> str:
        """The YAML of the mapping; keys without a column are comments."""
        lines = ["# Proposed by `slipgym map`: check every line, units above all."]
        for name, found in self.fingers.items():
            if name and len(lines) == 1:
                lines.append("fingers:")
            lines += [f"  {name}:"] if name else []
            lines += [f"{'    ' if name else ''}{_line(each)}" for each in found]
        lines += [f"# {key}: no column was found; write `{key}: NAME`" for key in self.missing]
        return "\n".join(lines) + "\n"


def _line(each: Proposed) -> str:
    quoted = "'" + each.column.replace("'", "''") + "'"
    parts = [f"{'position' if each.position else 'column'}: {quoted}"]
    parts += [f"unit: {each.unit}"] if each.unit else []
    parts += ["sign: -1"] if each.sign < 0 else []
    return f"{each.key}: {{{', '.join(parts)}}}"


def table(proposal: Proposal) -> list[str]:
    """Lines of a table for a terminal: what each column may be, and what is left."""
    rows = [["key", "column", "unit", "sign", "from", "to (SI)", "unit is"]]
    for name, found in proposal.fingers.items():
        for each in found:
            there = each.values[np.isfinite(each.values)]
            low, high = f"{there.min():.4g}", f"{there.max():.4g}"
            kind = f"{each.column}{' (position)' if each.position else ''}"
            key = f"{name} {each.key}".strip()
            rows.append([key, kind, each.unit or "–", "−" if each.sign < 0 else "", low, high, each.why])
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = ["  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip() for row in rows]
    lines.insert(1, "-" * max(map(len, lines)))
    lines += [f"{key}: no column was found" for key in proposal.missing]
    return [*lines, *([f"not used: {listed(proposal.rest)}"] if proposal.rest else [])]


def tried(path: Path, proposal: Proposal) -> tuple[str, list[str]]:
    """Reads the record with the proposal.

    Returns:
        Why that fails, empty if it does not; warnings about the readings.
    """
    told: dict[str, None] = {}
    try:
        columns = parse_columns(proposal.text(), "the mapping")
        for own in (columns.fingers or {"": columns}).values():
            record = load(path, own)
            samples = align(record, allow_gaps=True)
            told |= dict.fromkeys([*reading_warnings(record, samples), *fault_warnings(record, samples)])
    except ValueError as error:
        return str(error), []
    return "", list(told)


def picture(proposal: Proposal, title: str) -> Any:
    """A panel for each column over its rows, in the proposed units and signs.

    Raises:
        ModuleNotFoundError: matplotlib is not installed.
    """
    shown = [(name, each) for name, found in proposal.fingers.items() for each in found]
    figure = extra("matplotlib.figure").Figure(
        figsize=(10.0, 1.6 * (len(shown) + 2) // 2), layout="constrained"
    )
    panels = list(figure.subplots((len(shown) + 2) // 2, 2, squeeze=False).flat)
    for axes in panels[len(shown) :]:
        axes.axis("off")
    for axes, (name, each) in zip(panels, shown, strict=False):
        there = np.flatnonzero(np.isfinite(each.values))
        axes.plot(there, each.values[there], linewidth=0.7, color="#0072B2")
        first = next(iter(units_of(each.key, each.position)))
        axes.set_title(
            f"{name} {each.key} [{first}] = {each.column} [{each.unit or 'date'}]".strip(), fontsize=8
        )
        axes.tick_params(labelsize=7)
    figure.suptitle(f"{title}: what slipgym takes its columns for, over the rows", fontsize=9)
    return figure
