"""What infos tell of every environment, gathered while its records are at hand.

A row of plain numbers: numpy copies one of named fields field by field, which takes longer.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym.compiled import compiled

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
    "is_success": (),  # 0 or 1
    "dropped": (),  # 0 or 1
}
"""What infos hold besides the reward terms, in the order of a row, with its shape."""
FLAGS = "is_success", "dropped"
"""Names of those that are true or false."""
_SIZES = [math.prod(shape) for shape in SHAPES.values()]
WIDTH = sum(_SIZES)
"""Numbers in a row."""
_ENDS = np.cumsum(_SIZES).tolist()
PARTS = {name: slice(end - size, end) for name, end, size in zip(SHAPES, _ENDS, _SIZES, strict=True)}
"""Where they stand in it."""


def field(rows: np.ndarray, name: str) -> np.ndarray:
    """What is told of n environments under a name, a copy.

    Args:
        rows: From `tell`, (n, WIDTH).
        name: One of `SHAPES`.

    Returns:
        (n, ...), booleans for `FLAGS`.
    """
    part = rows[:, PARTS[name]]
    values = part != 0.0 if name in FLAGS else part.copy()
    return values.reshape(len(rows), *SHAPES[name])


@compiled
def tell(told, worlds, pads, fingers, episodes, truth, estimated, per_finger):
    """Write what is told, in the order of `SHAPES`.

    Args:
        told: Output (n, WIDTH).
        worlds: WORLD (n,).
        pads: PAD (n, 2).
        fingers: FINGER (n, 2).
        episodes: EPISODE (n,).
        truth: (n, 6), of which the first three are told.
        estimated: (n, 6), likewise.
        per_finger: Estimated mu_s, mu_c, r (n, 2, 3).
    """
    for i in range(told.shape[0]):
        row, world, episode = told[i], worlds[i], episodes[i]
        for k in range(3):
            row[k], row[3 + k] = truth[i, k], estimated[i, k]
            row[6 + k], row[9 + k] = per_finger[i, 0, k], per_finger[i, 1, k]
            row[12 + k], row[15 + k] = world.slip[k], world.slip_twist[k]
            row[18 + k], row[21 + k] = pads[i, 0].wrench[k], pads[i, 1].wrench[k]
            row[26 + k] = episode.reference[k]
        row[24], row[25] = fingers[i, 0].force, fingers[i, 1].force
        row[29] = episode.step * episode.step_time
        row[30], row[31] = episode.success, episode.dropped
