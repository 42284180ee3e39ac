"""Writes benchmark figures as a table and as JSON."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple

from slipgym import atomic_io

LIBRARIES = ("gymnasium", "numba", "numpy", "pybullet")


class Figure(NamedTuple):
    """One measured figure."""

    name: str
    """What was measured."""
    value: float
    """The result."""
    unit: str
    """Its unit."""
    required: str = ""
    """What is asked of it: "<= 1.4" or ">= 40", or nothing."""

    @property
    def met(self) -> bool | None:
        """Whether the requirement is met; None without one."""
        if not self.required:
            return None
        sign, bound = self.required.split()
        return self.value <= float(bound) if sign == "<=" else self.value >= float(bound)


def machine(*more: str) -> dict[str, Any]:
    """The machine and versions that figures depend on, with the versions of more libraries."""
    libraries = {name: _version(name) for name in (*LIBRARIES, *more)}
    return {"python": platform.python_version(), "cores": os.cpu_count(), **libraries}


def _version(library: str) -> str:
    try:
        return version(library)
    except PackageNotFoundError:
        return "not installed"


def line(facts: Mapping[str, Any]) -> str:
    """Names and values in a line."""
    return ", ".join(f"{name} {value}" for name, value in facts.items())


def publish(figures: Sequence[Figure], json: Path | None, *more: str) -> None:
    """Print figures, and write them to a file if there is one, with the versions of more libraries."""
    print(table(figures))
    if json is not None:
        write(json, figures, *more)


def table(figures: Sequence[Figure]) -> str:
    """Figures in aligned columns."""
    rows = [("figure", "value", "unit", "required")]
    for figure in figures:
        verdict = "" if figure.met is None else f"{figure.required}: {'yes' if figure.met else 'NO'}"
        rows.append((figure.name, f"{figure.value:.4g}", figure.unit, verdict))
    widths = [max(len(row[k]) for row in rows) for k in range(4)]
    rows.insert(1, tuple("-" * width for width in widths))  # type: ignore[arg-type]
    return "\n".join(
        f"{name:<{widths[0]}}  {value:>{widths[1]}}  {unit:<{widths[2]}}  {required}".rstrip()
        for name, value, unit, required in rows
    )


def write(path: Path, figures: Sequence[Figure], *more: str) -> None:
    """Write figures as JSON, with the versions of more libraries; the file appears complete or not at all."""
    content = {
        "machine": machine(*more),
        "figures": [{**figure._asdict(), "met": figure.met} for figure in figures],
    }
    atomic_io.write(path, json.dumps(content, indent=2).encode())
