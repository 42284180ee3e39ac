"""Tables as Markdown."""

from __future__ import annotations

import pandas as pd


def markdown(table: pd.DataFrame, digits: int = 2) -> str:
    """A table as Markdown; NaN is a dash, an infinite time is "never".

    Args:
        table: The table.
        digits: Digits after the point of numbers that are not whole.
    """

    def cell(value: object) -> str:
        if not isinstance(value, float):
            return str(value)
        if value == float("inf"):
            return "never"
        return "–" if value != value else f"{value:.{digits}f}".replace("-", "−")

    numbers = ["---:" if pd.api.types.is_numeric_dtype(table[name]) else "---" for name in table]
    rows = [list(map(str, table.columns)), numbers]
    rows += [[cell(value) for value in row] for row in table.astype(object).itertuples(index=False)]
    return "".join("| " + " | ".join(row) + " |\n" for row in rows)
