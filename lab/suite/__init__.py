"""The slip suite: the same scenes in slipgym and in other engines, each with settings its makers recommend.

`ENGINES` are the engines by name; `measure` runs all scenes in one `Variant` of an engine, `draw` draws.
MuJoCo comes with the extra `suite`; Drake and Newton are best installed in an environment of their own
(docs/slip_suite.md).
"""

from __future__ import annotations

import importlib
from collections.abc import Iterable

from lab.suite.figure import draw
from lab.suite.rig import Grasp, Variant
from lab.suite.table import Result, friction_table, measure, results_table

ENGINES = ("slipgym", "mujoco", "bullet", "drake", "newton")
"""Names of the engines; each has a module `<name>_rig` with a function `variants`."""


def variants(engines: Iterable[str]) -> list[Variant]:
    """The settings of some engines, rows of the tables, in order."""
    modules = [importlib.import_module(f"lab.suite.{name}_rig") for name in engines]
    return [variant for module in modules for variant in module.variants()]


def check(rows: Iterable[Variant]) -> None:
    """Raise RuntimeError if the engine of a row is not installed."""
    for row in rows:
        row.make(Grasp()).close()


__all__ = [
    "ENGINES",
    "Result",
    "Variant",
    "check",
    "draw",
    "friction_table",
    "measure",
    "results_table",
    "variants",
]
