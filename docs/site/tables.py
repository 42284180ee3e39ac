"""Writes the tables of the site that follow from declarations, where a page has `<!-- table: NAME -->`."""

import re
from collections.abc import Iterable

import gymnasium as gym
from records import rows

from slipgym.config import load_randomization
from slipgym.config.distribution import Distribution
from slipgym.config.randomization import Ranges

PRESETS = ("train", "lab", "eval_ood")
MARK = re.compile(r"<!-- table: ([\w -]+) -->")


def filled(page: str) -> str:
    """The page with its tables.

    Raises:
        KeyError: There is no table of a name.
    """
    return MARK.sub(lambda mark: TABLES[mark[1]](), page)


def table(head: str, rows: Iterable[Iterable[str]]) -> str:
    """Markdown of a table.

    Args:
        head: Names of the columns, with bars between them.
        rows: Cells of each row.
    """
    lines = [" | ".join(row) for row in rows]
    return "\n".join(f"| {line} |" for line in [head, "|".join(["---"] * (head.count("|") + 1)), *lines])


def said(value: object) -> str:
    """A field's value in words."""
    if not value:
        return "-"
    if isinstance(value, Distribution):
        if value.choices is not None:
            return ", ".join(f"{choice:g}" for choice in value.choices)
        return f"{value.ends[0]:g} to {value.ends[1]:g}" + (", log" if value.log_uniform else "")
    assert isinstance(value, tuple)
    return ", ".join(value)


def privileged_columns() -> str:
    """Columns of the group "privileged" with their bounds."""
    env = gym.make("slipgym:slipgym/Hold-v0", engine="planar", observation_mode="dict")
    rows = [
        (f"`{column.name}`", f"{column.low:g}", f"{column.high:g}", column.unit, column.meaning)
        for column in env.unwrapped.privileged_columns
    ]
    env.close()
    return table("Column | Min | Max | Unit | Meaning", rows)


def fields() -> str:
    """Fields of a randomization, with their distributions in the presets."""
    presets = [load_randomization(name) for name in PRESETS]
    rows = [
        (f"`{name}`", field.description or "", *(said(getattr(preset, name)) for preset in presets))
        for name, field in Ranges.model_fields.items()
        if name != "disturbances"
    ]
    return table("Field | Meaning | train | lab | eval_ood", rows)


def disturbances() -> str:
    """Disturbances of the presets."""
    rows = []
    for preset in ("train", "eval_ood"):
        for disturbance in load_randomization(preset).disturbances:
            values = [(name, value) for name, value in disturbance if isinstance(value, Distribution)]
            listed = "; ".join(f"{name} {said(value)}" for name, value in values)
            rows.append((preset, f"`{disturbance.kind}`", f"{disturbance.probability:g}", listed))
    return table("Preset | Kind | Probability | Distributions", rows)


def single_tasks() -> str:
    """Fields that the presets override for single tasks."""
    rows = []
    for preset in ("train", "eval_ood"):
        for task, own in load_randomization(preset).tasks.items():
            named = [name for name in Ranges.model_fields if name in own.model_fields_set]
            listed = "; ".join(
                f"{name} {said(getattr(own, name))}" for name in named if name != "disturbances"
            )
            rows.append((preset, f"`{task}`", listed))
    return table("Preset | Task | Fields that differ", rows)


def record_fields() -> str:
    """Fields of the records that the functions of a task read."""
    return table("Field | Unit | Meaning", rows())


TABLES = {
    "privileged columns": privileged_columns,
    "randomization fields": fields,
    "randomization disturbances": disturbances,
    "randomization single tasks": single_tasks,
    "record fields": record_fields,
}
"""Name -> function that writes the table."""
