"""Selects rows of tables by several values, or by all but one."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
import pandas as pd

from policies.evaluation.frames import values


def among(frame: pd.DataFrame, column: str, wanted: Collection[object]) -> pd.DataFrame:
    """The rows whose column has one of the given values."""
    return frame.loc[np.array([value in wanted for value in frame[column]], dtype=bool)]


def without(frame: pd.DataFrame, column: str, value: object) -> pd.DataFrame:
    """The rows whose column has another value."""
    return frame.loc[values(frame, column) != value]
