"""Checks of contact arguments, with errors that name the value and the valid range."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np


def positive(allow_zero: bool = False, **values: float) -> None:
    """Raise ValueError unless every value is finite and > 0 (or >= 0)."""
    bound = ">= 0" if allow_zero else "> 0"
    for name, value in values.items():
        if not math.isfinite(value) or value < 0.0 or (value == 0.0 and not allow_zero):
            raise ValueError(f"{name} = {value!r} must be finite and {bound}")


def check_friction(mu_c: float, mu_s: float) -> None:
    """Raise ValueError unless 0 < mu_c <= mu_s, both finite."""
    positive(mu_c=mu_c, mu_s=mu_s)
    if mu_s < mu_c:
        raise ValueError(f"mu_s = {mu_s!r} must be at least mu_c = {mu_c!r}")


def finite_vector(name: str, values: Sequence[float], length: int) -> np.ndarray:
    """Return `values` as a float array of the given length, or raise ValueError."""
    array = np.asarray(values, dtype=float)
    if array.shape != (length,):
        raise ValueError(f"{name} must have {length} components, got shape {array.shape}")
    if not np.all(np.isfinite(array)):
        raise ValueError(f"{name} = {array.tolist()} must be finite")
    return array
