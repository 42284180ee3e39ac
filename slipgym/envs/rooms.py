"""Arrays of zeros with some rows filled in, made again and again: thousands of zeros take their time."""

from __future__ import annotations

import sys

import numpy as np

KEPT = 4
"""Arrays that are kept at most: a caller still has the last one, or some, when it gets the next."""
_OURS = 2
"""References to an array that nobody else has: the list's and the argument's."""


class Rooms:
    """Arrays (n, width) that are their receiver's own for as long as it keeps them or a view of them.

    One that nobody refers to any more is taken back, and only the rows that were filled in are cleared.

    Args:
        n: Rows.
        width: Columns.
    """

    def __init__(self, n: int, width: int) -> None:
        self._shape = n, width
        self._rooms: list[np.ndarray] = []
        self._filled: list[np.ndarray] = []

    def fill(self, rows: np.ndarray, values: np.ndarray) -> np.ndarray:
        """An array of zeros but for some rows.

        Args:
            rows: Which, (m,).
            values: What they hold, (m, width).
        """
        free = (k for k in range(len(self._rooms)) if sys.getrefcount(self._rooms[k]) <= _OURS)
        k = next(free, -1)
        if k < 0:
            room = np.zeros(self._shape)
            if len(self._rooms) < KEPT:
                self._rooms.append(room)
                self._filled.append(rows)
        else:
            room = self._rooms[k]
            room[self._filled[k]] = 0.0
            self._filled[k] = rows
        room[rows] = values
        return room
