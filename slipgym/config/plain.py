"""Converts numpy's numbers, truth values, texts and arrays to Python's own, at every depth."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def plain(value: Any, seen: dict[int, Any] | None = None) -> Any:
    """Return a value without numpy in it: numbers as int or float, arrays as lists, mappings as dicts.

    Other values stay as they are, and so does a container inside itself.

    Args:
        value: Any value.
        seen: Containers that were converted, by identity.
    """
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, np.generic):
        return float(value) if isinstance(value, np.floating) else value.item()
    if not isinstance(value, Mapping | list | tuple):
        return value
    seen = {} if seen is None else seen
    if id(value) in seen:
        return seen[id(value)]
    seen[id(value)] = value
    if isinstance(value, Mapping):
        made: Any = {plain(key, seen): plain(each, seen) for key, each in value.items()}
    else:
        made = [plain(each, seen) for each in value]
        made = tuple(made) if isinstance(value, tuple) else made
    seen[id(value)] = made
    return made
