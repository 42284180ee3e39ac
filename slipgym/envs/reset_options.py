"""Checks what the reset of a vector environment is asked for: seeds, options for all and for each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import groupby
from typing import Any

import numpy as np
from gymnasium.utils import seeding

from slipgym.envs.states import restored_generator
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
        self._common = _nothing(kind) if given in (None, {}) else kind.parse(given)
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

    def place(self, options: EpisodeOptions, row: int) -> str:
        """Returns what an error begins with: where the options were given, if for this row alone."""
        return "" if options is self._common else f"options['rows'][{row}]: "


@cache
def _nothing(kind: type[EpisodeOptions]) -> EpisodeOptions:
    """The options that fix nothing: the same object, which is compared quickly."""
    return kind.parse(None)


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


class Generators:
    """Random generators, the same as those of scalar environments with the same seeds.

    Args:
        n: Number of environments.
    """

    def __init__(self, n: int) -> None:
        self._n = n
        self._generators: list[np.random.Generator | None] = [None] * n

    def seed(self, seed: int | Sequence[int | None] | None, mask: np.ndarray) -> None:
        """Seed the environments of a mask (n,).

        Args:
            seed: Seed of the first environment, where environment i gets seed + i; or one for each; None
                leaves the generators as they are.
            mask: Environments to seed, (n,) bool.

        Raises:
            ValueError: There are not as many seeds as environments, or one is not a whole number >= 0.
        """
        if seed is None:
            return
        if isinstance(seed, (int, np.integer)) and not isinstance(seed, bool):
            seeds: Sequence[Any] = range(int(seed), int(seed) + self._n)
        elif isinstance(seed, (Sequence, np.ndarray)) and not isinstance(seed, str):
            seeds = seed
        else:
            raise ValueError(f"seed = {seed!r} must be None, a whole number >= 0 or a list of them")
        if len(seeds) != self._n:
            raise ValueError(f"seed: {len(seeds)} seeds for {self._n} environments")
        asked = [(i, seeds[i]) for i in np.flatnonzero(mask).tolist() if seeds[i] is not None]
        for i, one in asked:
            if isinstance(one, bool) or not isinstance(one, (int, np.integer)) or one < 0:
                raise ValueError(f"seed = {one!r} of environment {i} must be a whole number >= 0")
        for i, one in asked:
            self._generators[i] = seeding.np_random(int(one))[0]

    def get_state(self) -> list[Mapping[str, Any]]:
        """States of all generators."""
        return [self[i].bit_generator.state for i in range(self._n)]

    def restored(self, states: Sequence[Mapping[str, Any]]) -> Generators:
        """Generators with these states, one for each environment."""
        made = Generators(self._n)
        made._generators[:] = map(restored_generator, states)
        return made

    def __getitem__(self, i: int) -> np.random.Generator:
        """The generator of environment i; the operating system seeds one that was never seeded."""
        generator = self._generators[i]
        if generator is None:
            generator = self._generators[i] = seeding.np_random()[0]
        return generator
