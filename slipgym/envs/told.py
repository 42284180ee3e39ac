"""What infos tell of every environment, gathered while its records are at hand."""

from __future__ import annotations

import numpy as np

from slipgym.compiled import compiled

TOLD = np.dtype(
    [
        ("true", "f8", 3),  # mu_s, mu_c [-], r [m] now
        ("estimated", "f8", 3),  # the same as estimated, both fingers together
        ("estimated_per_finger", "f8", (2, 3)),
        ("slip", "f8", 3),  # displacement (x, y, theta) [m, m, rad]
        ("slip_twist", "f8", 3),  # [m/s, m/s, rad/s]
        ("contact_wrench", "f8", (2, 3)),  # of friction on the object, per finger [N, N, N m]
        ("grip_force", "f8", 2),  # of the actuators [N]
        ("reference", "f8", 3),  # position, velocity, acceleration
        ("is_success", "?"),
        ("dropped", "?"),
        ("time", "f8"),  # since reset [s]
    ],
    align=True,
)
"""What infos hold besides the reward terms, by name."""


@compiled
def tell(told, worlds, pads, fingers, episodes, truth, estimated, per_finger):
    """Write what is told.

    Args:
        told: Output, TOLD (n,).
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
            row.true[k], row.estimated[k] = truth[i, k], estimated[i, k]
            row.slip[k], row.slip_twist[k] = world.slip[k], world.slip_twist[k]
            row.reference[k] = episode.reference[k]
            for f in range(2):
                row.estimated_per_finger[f, k] = per_finger[i, f, k]
                row.contact_wrench[f, k] = pads[i, f].wrench[k]
        for f in range(2):
            row.grip_force[f] = fingers[i, f].force
        row.is_success, row.dropped = episode.success, episode.dropped
        row.time = episode.step * episode.step_time
