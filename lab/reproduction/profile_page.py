"""Sets the errors along the velocity profile out as tables, a column for each estimator."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from lab.reproduction.tables import grid
from policies.evaluation.frames import distinct, values, where

SHOWN, EXACT = "realistic", ("ideal", "disc")
"""Sensors of the estimators' columns; those and the estimator of the last column."""


def page(phases: pd.DataFrame, events: pd.DataFrame) -> str:
    """Errors of mu_c, r and mu_s with realistic sensors as Markdown, means over the records [%].

    Args:
        phases: From `lab.reproduction.profile.phases`, of all sensors and estimators.
        events: From `lab.reproduction.profile.events`, likewise.
    """
    parts = []
    for quantity in ("mu_c", "r"):
        given = {"gamma_t": ("{:.2f}", "gamma_t"), "predicted": ("{:+.1f}", f"{quantity}_predicted_%")}
        parts.append(_table(phases, quantity, "phase", f"{quantity}_%", given))
    parts.append(_table(events, "mu_s", "event", "error_%", {"true mu_s": ("{:.2f}", "mu_s")}))
    return "\n\n".join(parts) + "\n"


def _table(found: pd.DataFrame, title: str, rows: str, column: str, given: dict[str, tuple[str, str]]) -> str:
    """A table with its title.

    Args:
        found: The errors.
        title: The quantity.
        rows: Column of the names of the rows.
        column: Column of the error.
        given: Heading -> format and column, of what does not depend on the estimator.
    """
    names = distinct(found, "estimator")
    shown = {name: where(found, sensors=SHOWN, estimator=name) for name in names}
    first = shown[names[0]]
    columns = [_cells(values(first, name).tolist(), form) for form, name in given.values()]
    columns += [_cells(values(own, column).tolist(), "{:+.1f}") for own in shown.values()]
    exact = where(found, sensors=EXACT[0], estimator=EXACT[1])
    columns.append(_cells(values(exact, column).tolist(), "{:+.1f}"))
    headings = [rows, *given, *names, f"{EXACT[1]}, exact"]
    lines = [list(line) for line in zip(distinct(first, rows), *columns, strict=True)]
    return f"## Error of {title} [%]\n\n{grid(headings, lines)}"


def _cells(numbers: Sequence[float], form: str) -> list[str]:
    """Numbers as text; a dash for NaN."""
    return ["–" if number != number else form.format(number).replace("-", "−") for number in numbers]
