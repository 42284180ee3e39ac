"""A random generator for each environment of a batch."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from gymnasium.utils import seeding


class Generators:
    """Those that scalar environments with the same seeds would have.

    Args:
        n: Environments.
    """

    def __init__(self, n: int) -> None:
        self._n = n
        self._generators: list[np.random.Generator | None] = [None] * n

    def seed(self, seed: int | Sequence[int | None] | None, mask: np.ndarray) -> None:
        """Seed the environments of a mask (n,).

        Args:
            seed: Of the first, the others count up from it; one for each; None: they go on as they are.
            mask: Which environments.

        Raises:
            ValueError: There are not as many seeds as environments, or one is not a whole number >= 0.
        """
        if seed is None:
            return
        if isinstance(seed, (int, np.integer)) and not isinstance(seed, bool):
            seeds: list[int | None] = [int(seed) + i for i in range(self._n)]
        elif isinstance(seed, (Sequence, np.ndarray)) and not isinstance(seed, str):
            seeds = [None if one is None else int(one) for one in seed]
        else:
            raise ValueError(f"seed = {seed!r} must be None, a whole number >= 0 or a list of them")
        if len(seeds) != self._n:
            raise ValueError(f"seed: {len(seeds)} seeds for {self._n} environments")
        for i in np.flatnonzero(mask).tolist():
            one = seeds[i]
            if one is not None:
                if one < 0:
                    raise ValueError(f"seed = {one} must be a whole number >= 0")
                self._generators[i] = seeding.np_random(one)[0]

    def __getitem__(self, i: int) -> np.random.Generator:
        """That of environment i; one that was never seeded is seeded by the operating system."""
        generator = self._generators[i]
        if generator is None:
            generator = self._generators[i] = seeding.np_random()[0]
        return generator
