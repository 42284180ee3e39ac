"""Warns of signs that slip contradicts: friction takes energy from the motion along every axis."""

from __future__ import annotations

import numpy as np

from estimator.online import TWIST, WRENCH
from estimator.records.alignment import Samples

_AXES = ((0, 0), (1, 1), (3, 2))
"""Components of the wrench and of the twist that go along with each other."""
_SLIDES, _TURNS = 3e-3, 0.1
"""Speed [m/s] and rate [rad/s] above the noise of a slip-velocity sensor."""
_FORCE, _TORQUE, _LEVER = 0.5, 3e-3, 0.003
"""Force [N], torque [N m] and torque over force [m] above zero errors and an error of the CoP."""
_PART, _USUAL = 0.6, 0.008
"""Least share of the axis in the motion, with the usual radius r [m] of pads."""
_ENOUGH, _MOST = 20, 0.8
"""Samples of an axis, and the share of them that shows its sign."""


def sign_warnings(samples: Samples) -> list[str]:
    """A line for each axis along which the force goes against the slip, or one for all of them.

    Args:
        samples: A record's samples as given to an estimator.
    """
    wrench, twist = samples.wrench, samples.twist * [1.0, 1.0, _USUAL]
    speed, force = np.linalg.norm(twist, axis=1), np.hypot(*wrench[:, :2].T)
    least = _FORCE, _FORCE, np.maximum(_TORQUE, _LEVER * force)
    slowest = _SLIDES, _SLIDES, _USUAL * _TURNS
    shown, against = [], []
    for (k, axis), loaded, slow in zip(_AXES, least, slowest, strict=True):
        along, moved = wrench[:, k], twist[:, axis]
        clear = (np.abs(moved) > np.maximum(slow, _PART * speed)) & (np.abs(along) > loaded)
        if np.count_nonzero(clear) < _ENOUGH:
            continue
        share = float((along * moved < 0.0)[clear].mean())
        shown.append(share)
        if share > _MOST:
            against.append((WRENCH[k], TWIST[axis]))
    if len(against) > 1 and len(against) == len(shown):
        names = [name for name, _ in against]
        turns = ", ".join(f"`{name}: {{sign: -1}}`" for name in names)
        return [
            f"Warning: {', '.join(names)} go against the slip, but friction goes along with it: are they the "
            f"load of the pad on the object? {turns} in the mapping turn them."
        ]
    return [
        f"Warning: {force} goes against {speed} in slip, but friction goes along with it: one of them has "
        f"the wrong sign. `{speed}: {{sign: -1}}` in the mapping turns the velocity, `{force}: {{sign: -1}}` "
        f"the {'torque' if force == 'tau' else 'force'}."
        for force, speed in against
    ]
