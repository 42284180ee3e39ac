"""Keeps a random generator for each environment of a vector environment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium.utils import seeding

from slipgym.envs.states import restored_generator


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
