"""Keeps what the randomization sampled for every episode, for its info."""

from __future__ import annotations

from functools import lru_cache
from itertools import compress
from typing import Any

import numpy as np

from slipgym.envs.randomizer import Randomizer
from slipgym.envs.values import FIXED_BY, FRICTION, NAMES, SIZE, flat, labels, places
from slipgym.tasks.options import EpisodeOptions

FIRST = ("mu_s", "mu_c", "mass")
"""What comes before the sampled values: friction and mass of the episode, sampled or not."""
WHOLE = ("slip_latency",)
"""Values that are whole numbers."""
TEXTS = ("pressure", "disturbances")
"""What comes after the sampled values."""


class Drawn:
    """What the randomization sampled for the episodes of n environments and no option fixed.

    Args:
        randomizer: Samples it.
        n: Number of environments.
    """

    def __init__(self, randomizer: Randomizer, n: int) -> None:
        self._randomizer, self._n = randomizer, n
        self._pressures = list(randomizer.variants)
        self._numbers = np.zeros((n, len(FIRST) + SIZE))
        self._happened = np.zeros((n, len(randomizer.kinds)), dtype=bool)
        self._known: list[tuple[str, ...]] = [()] * n

    def reported(self, options: EpisodeOptions) -> tuple[str, ...]:
        """What is reported of episodes with some reset options: `FIRST`, and fields of `VALUES`."""
        drawn = (name for name in self._randomizer.drawn if name not in FRICTION + NAMES)
        return *FIRST, *(
            name for name in drawn if name not in FIXED_BY or getattr(options, FIXED_BY[name]) is None
        )

    def keep(
        self,
        rows: np.ndarray,
        known: tuple[str, ...],
        starts: np.ndarray,
        values: np.ndarray,
        happened: np.ndarray,
    ) -> None:
        """Keep what was sampled for episodes that begin.

        Args:
            rows: Their environments, (m,).
            known: From `reported`, of the options of all of them.
            starts: START (m,).
            values: VALUES (m,).
            happened: Whether each disturbance happens, (m, d).
        """
        if not self._randomizer.active:
            return
        self._numbers[rows, :2], self._numbers[rows, 2] = starts["friction"][:, :2], starts["mass"]
        self._numbers[rows, len(FIRST) :] = flat(values)
        self._happened[rows] = happened
        for i in rows.tolist():
            self._known[i] = known

    def one(self, i: int) -> dict[str, Any]:
        """What was sampled for environment i, JSON-like; empty without randomization."""
        if not self._known[i]:
            return {}
        names, columns = _columns(self._known[i])
        numbers = dict(zip(names, self._numbers[i, columns].tolist(), strict=True))
        numbers |= {name: round(numbers[name]) for name in WHOLE if name in numbers}
        return numbers | {name: texts[0] for name, texts in zip(TEXTS, self._texts([i]), strict=True)}

    def some(self, rows: np.ndarray) -> dict[str, Any]:
        """Infos of some environments (m,) as `gymnasium.vector.VectorEnv` returns them; may be empty."""
        groups: dict[tuple[str, ...], list[int]] = {}
        for i in rows.tolist():
            groups.setdefault(self._known[i], []).append(i)
        groups.pop((), None)
        if not groups:
            return {}
        names = list(dict.fromkeys(name for known in groups for name in _columns(known)[0]))
        numbers = np.zeros((self._n, len(names)))
        masks = np.zeros((self._n, len(names) + len(TEXTS) + 1), dtype=bool)
        for known, own in groups.items():
            mine, columns = _columns(known)
            cells: Any = own  # whole rows, but where other environments have other names
            if mine != names:
                cells = np.array(own)[:, np.newaxis], [names.index(name) for name in mine]
            numbers[cells], masks[cells] = self._numbers[own][:, columns], True
        masks[rows, len(names) :] = True
        infos: dict[str, Any] = {}
        for k, name in enumerate(names):
            infos[name], infos[f"_{name}"] = numbers[:, k], masks[:, k]
        for name in infos.keys() & set(WHOLE):
            infos[name] = np.zeros(self._n, dtype=np.int64)
            infos[name][rows] = numbers[rows, names.index(name)]
        for k, texts in enumerate(self._texts(rows.tolist())):
            infos[TEXTS[k]], infos[f"_{TEXTS[k]}"] = np.empty(self._n, dtype=object), masks[:, len(names) + k]
            infos[TEXTS[k]][rows] = texts
        return {"drawn": infos, "_drawn": masks[:, -1]}

    def _texts(self, rows: list[int]) -> tuple[list[str], list[str]]:
        """`TEXTS` of environments."""
        places_of = self._numbers[rows, len(FIRST) + places("pressure").start].tolist()
        happened, kinds = self._happened[rows].tolist(), self._randomizer.kinds
        pressures = [self._pressures[round(place)] for place in places_of]
        return pressures, [", ".join(compress(kinds, flags)) for flags in happened]


@lru_cache
def _columns(known: tuple[str, ...]) -> tuple[list[str], list[int]]:
    """Names and places of the numbers of FIRST and of some fields of VALUES in a row."""
    names: list[str] = list(FIRST)
    columns = list(range(len(FIRST)))
    for name in known[len(FIRST) :]:
        own = places(name)
        names += labels(name)
        columns += range(len(FIRST) + own.start, len(FIRST) + own.stop)
    return names, columns
