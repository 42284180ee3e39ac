"""Warns of signs that slip contradicts: friction takes energy from the motion along every axis."""

from __future__ import annotations

import numpy as np

from estimator.online import TWIST, WRENCH
from estimator.records.alignment import Samples

_AXES = ((0, 0), (1, 1), (3, 2))
"""Components of the wrench and of the twist that go along with each other."""
_SLIDES, _TURNS, _FORCE, _TORQUE, _LEVER = 3e-3, 0.1, 0.5, 3e-3, 0.003
"""Speed [m/s], rate [rad/s], force [N], torque [N m] torque over force [m] above the errors of sensors."""
_PART, _USUAL, _ENOUGH, _WAY, _MOST = 0.6, 0.008, 20, 2e-3, 0.8
"""Share of the axis in the motion, by the usual radius r [m]; samples, and their way [m], farther than a pad
springs back; the share of them that shows the sign."""


def sign_warnings(samples: Samples) -> list[str]:
    """A line for each axis along which the force goes against the slip, or one for all of them.

    Args:
        samples: A record's samples as given to an estimator.
    """
    wrench, twist = samples.wrench, samples.twist * [1.0, 1.0, _USUAL]
    speed, force = np.linalg.norm(twist, axis=1), np.hypot(*wrench[:, :2].T)
    least = _FORCE, _FORCE, np.maximum(_TORQUE, _LEVER * force)
    slowest = _SLIDES, _SLIDES, _USUAL * _TURNS
    shown, against = 0, []
    for (k, axis), loaded, slow in zip(_AXES, least, slowest, strict=True):
        along, moved = wrench[:, k], twist[:, axis]
        clear = (np.abs(moved) > np.maximum(slow, _PART * speed)) & (np.abs(along) > loaded)
        way = float(np.abs(moved * np.diff(samples.t, prepend=samples.t[0]))[clear].sum())
        if np.count_nonzero(clear) >= _ENOUGH and way > _WAY:
            shown += 1
            if (along * moved < 0.0)[clear].mean() > _MOST:
                against.append((WRENCH[k], TWIST[axis]))
    if shown == len(against) > 1:
        turns = ", ".join(f"`{name}: {{sign: -1}}`" for name, _ in against)
        return [
            "Warning: the forces go against the slip, but friction goes along with it: are they those of the "
            f"pad on the object? {turns} in the mapping turn them."
        ]
    return [
        f"Warning: {force} goes against {speed} in slip, but friction goes along with it: one of them has "
        f"the wrong sign. `{speed}: {{sign: -1}}` or `{force}: {{sign: -1}}` in the mapping turns it."
        for force, speed in against
    ]
