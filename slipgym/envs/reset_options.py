"""Checks the reset options of a vector environment, those for all environments and those for each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

import numpy as np

from slipgym.tasks.options import EpisodeOptions


class RowOptions:
    """Checked options of a reset.

    Args:
        options: Episode parameters for all; "rows": None or a mapping for each; "reset_mask": (n,) bool.
        n: Number of environments.
        kind: The task's options.

    Attributes:
        mask: Environments to reset, (n,) bool.

    Raises:
        ValueError: An option is unknown, its value not allowed, or there are not n rows or masks.
        TypeError: The mask is not an array of booleans.
    """

    def __init__(self, options: Mapping[str, Any] | None, n: int, kind: type[EpisodeOptions]) -> None:
        given = dict(options) if isinstance(options, Mapping) else options
        rows, mask = None, None
        if isinstance(given, dict):
            rows, mask = given.pop("rows", None), given.pop("reset_mask", None)
            rows = rows.tolist() if isinstance(rows, np.ndarray) else rows
        self.mask = np.ones(n, dtype=bool) if mask is None else _checked_mask(mask, n)
        self._common = kind.parse(given)
        self._rows: list[EpisodeOptions] | None = None
        if rows is not None:
            if not isinstance(rows, Sequence) or len(rows) != n:
                raise ValueError(f"options['rows'] must be a list of {n} mappings or None, got {rows!r:.80}")
            self._rows = [
                self._common if row is None or row == {} else _row(i, row, given or {}, kind)
                for i, row in enumerate(rows)
            ]

    def groups(self, rows: np.ndarray) -> Iterator[tuple[EpisodeOptions, np.ndarray]]:
        """Rows (m,) in their order, those together that follow each other and have the same options."""
        if self._rows is None:
            yield self._common, rows
            return
        own = self._rows
        for _, some in groupby(rows.tolist(), lambda i: id(own[i])):
            together = np.array(list(some))
            yield own[together[0]], together


def _row(i: int, row: Any, common: Mapping[str, Any], kind: type[EpisodeOptions]) -> EpisodeOptions:
    try:
        return kind.parse(row if not isinstance(row, Mapping) else {**common, **row})
    except ValueError as error:
        raise ValueError(f"options['rows'][{i}]: {error}") from None


def _checked_mask(mask: Any, n: int) -> np.ndarray:
    if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
        raise TypeError(f"options['reset_mask'] must be a numpy array of booleans, got {mask!r:.80}")
    if mask.shape != (n,):
        raise ValueError(f"options['reset_mask'] must have shape ({n},), got {mask.shape}")
    if not mask.any():
        raise ValueError("options['reset_mask'] must hold at least one True")
    return mask.copy()
