"""Infos of a few environments out of thousands, whose arrays are made once: so many zeros take their time."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.envs.told import Told

KEPT = 4
"""Rooms that are kept at most: a caller still has the last infos, or some, when it gets the next."""


class Room:
    """Arrays for what is told of n environments, zero but for some rows.

    Args:
        n: Environments.
        terms: Names of the reward terms.
    """

    def __init__(self, n: int, terms: Sequence[str]) -> None:
        self._told, self._rows = Told.zeros(n, len(terms)), np.zeros(0, dtype=np.int64)
        self._named = self._told.named(terms)
        self._terms = self._named.pop("reward_terms")
        self._references = self._count()

    @property
    def free(self) -> bool:
        """Whether nobody has one of the arrays, or a view of one."""
        return self._count() == self._references

    def fill(self, rows: np.ndarray, told: Told) -> dict[str, Any]:
        """What is told of some environments by its names; the receiver's own for as long as it has any of it.

        What the receiver writes into numbers of other rows, which mean nothing, is not cleared.

        Args:
            rows: Which, (m,).
            told: Of all n.
        """
        self._told.flags.fill(False)
        _move(self._rows, rows, *told, *self._told)
        self._rows = rows
        views = {name: array[:] for name, array in self._named.items()}
        return {**views, "reward_terms": {name: array[:] for name, array in self._terms.items()}}

    def _count(self) -> int:
        return sum(map(sys.getrefcount, self._told))


class Rooms:
    """Rooms that are taken back when nobody refers to them any more; then only filled rows are cleared.

    Args:
        n: Environments.
        terms: Names of the reward terms.
    """

    def __init__(self, n: int, terms: Sequence[str]) -> None:
        self._made_for = n, terms
        self._rooms: list[Room] = []

    def fill(self, rows: np.ndarray, told: Told) -> dict[str, Any]:
        """See `Room.fill`; in a room that is free."""
        room = next((room for room in self._rooms if room.free), None)
        if room is None:
            room = Room(*self._made_for)
            if len(self._rooms) < KEPT:
                self._rooms.append(room)
        return room.fill(rows, told)


@compiled
def _move(former, rows, told_numbers, told_flags, told_terms, numbers, flags, terms):
    """Zeros in the former rows (k,) of a room, what is told in others (m,)."""
    for i in former:
        numbers[i], flags[i], terms[i] = 0.0, False, 0.0
    for i in rows:
        numbers[i], flags[i], terms[i] = told_numbers[i], told_flags[i], told_terms[i]
