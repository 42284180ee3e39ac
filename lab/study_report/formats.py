"""Numbers as the report writes them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

MINUS = "−"


def number(value: float, digits: int = 0) -> str:
    """A number with a proper minus; a dash for none."""
    if math.isnan(value):
        return "–"
    text = f"{value:.{digits}f}"
    return (text if float(text) else text.lstrip("-")).replace("-", MINUS)


def figure(row: Mapping[str, Any], name: str, scale: float = 1.0, digits: int = 0) -> str:
    """A figure of a row, without its interval."""
    return number(scale * row[name], digits)


def interval(row: Mapping[str, Any], name: str, scale: float = 1.0, digits: int = 0) -> str:
    """The interval of a figure of a row, as "3 to 5"; empty where there is none."""
    ends = [scale * row[f"{name}_{end}"] for end in ("low", "high")]
    if any(map(math.isnan, ends)):
        return ""
    return " to ".join(f"{MINUS}∞" if math.isinf(end) else number(end, digits) for end in ends)


FILTERS: dict[str, Callable[..., str]] = {"number": number, "figure": figure, "interval": interval}
"""For the template."""
