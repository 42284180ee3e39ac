"""What infos tell of every environment, gathered while its records are at hand.

A row of plain numbers: numpy copies one of named fields field by field, which takes longer.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from slipgym._numba.compiled import compiled

SHAPES: dict[str, tuple[int, ...]] = {
    "true": (3,),  # mu_s, mu_c [-], r [m] now
    "estimated": (3,),  # the same as estimated, both fingers together
    "estimated_per_finger": (2, 3),
    "slip": (3,),  # displacement (x, y, theta) [m, m, rad]
    "slip_twist": (3,),  # [m/s, m/s, rad/s]
    "contact_wrench": (2, 3),  # of friction on the object, per finger [N, N, N m]
    "grip_force": (2,),  # of the actuators [N]
    "reference": (3,),  # position, velocity, acceleration
    "time": (),  # since reset [s]
}
"""Numbers that infos hold besides the reward terms, in the order of a row, with their shapes."""
FLAGS = "is_success", "dropped"
"""What is true or false in them, in the order of a row."""
_SIZES = [math.prod(shape) for shape in SHAPES.values()]
_WIDTH = sum(_SIZES)
_ENDS = np.cumsum(_SIZES).tolist()
PARTS = {name: slice(end - size, end) for name, end, size in zip(SHAPES, _ENDS, _SIZES, strict=True)}
"""Where the numbers stand in a row."""


class Told(NamedTuple):
    """What is told of n environments."""

    numbers: np.ndarray
    """See `SHAPES`, (n, 30)."""
    flags: np.ndarray
    """See `FLAGS`, (n, 2) bool."""
    terms: np.ndarray
    """Reward terms of the last step, summed over its samples, (n, k)."""

    @classmethod
    def zeros(cls, n: int, terms: int) -> Told:
        """Of n environments of a task with so many reward terms."""
        return cls(np.zeros((n, _WIDTH)), np.zeros((n, len(FLAGS)), dtype=bool), np.zeros((n, terms)))

    def empty_like(self) -> Told:
        """As many arrays of the same shapes, to be filled in."""
        return Told(*map(np.empty_like, self))

    def named(self, terms: Sequence[str]) -> dict[str, Any]:
        """Views of all by their names; the reward terms, by names that are given, in a dictionary inside."""
        numbers, flags, values = self
        views: dict[str, Any] = {
            name: numbers[:, PARTS[name]].reshape(-1, *shape) for name, shape in SHAPES.items()
        }
        views |= {name: flags[:, k] for k, name in enumerate(FLAGS)}
        views["reward_terms"] = {name: values[:, k] for k, name in enumerate(terms)}
        return views


@compiled
def tell(numbers, flags, worlds, pads, fingers, episodes, truth, estimated, per_finger):
    """Write what is told but for the reward terms.

    Args:
        numbers: Output (n, 30), see `SHAPES`.
        flags: Output (n, 2), see `FLAGS`.
        worlds: WORLD (n,).
        pads: PAD (n, 2).
        fingers: FINGER (n, 2).
        episodes: EPISODE (n,).
        truth: (n, 6), of which the first three are told.
        estimated: (n, 6), likewise.
        per_finger: Estimated mu_s, mu_c, r (n, 2, 3).
    """
    for i in range(numbers.shape[0]):
        row, world, episode = numbers[i], worlds[i], episodes[i]
        for k in range(3):
            row[k], row[3 + k] = truth[i, k], estimated[i, k]
            row[6 + k], row[9 + k] = per_finger[i, 0, k], per_finger[i, 1, k]
            row[12 + k], row[15 + k] = world.slip[k], world.slip_twist[k]
            row[18 + k], row[21 + k] = pads[i, 0].wrench[k], pads[i, 1].wrench[k]
            row[26 + k] = episode.reference[k]
        row[24], row[25] = fingers[i, 0].force, fingers[i, 1].force
        row[29] = episode.step * episode.step_time
        flags[i, 0], flags[i, 1] = episode.success, episode.dropped
