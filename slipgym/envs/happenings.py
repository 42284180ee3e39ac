"""Writes the disturbances of an episode into it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from slipgym.config.disturbances import AnyDisturbance, FrictionJump, MassChange, Patch, Push, Shake

SHARES = 8
"""Draws of a disturbance: as many as the kind with the most needs."""


def enter(disturbance: AnyDisturbance, shares: np.ndarray, episode: np.void) -> None:
    """Write a disturbance into an episode.

    Args:
        disturbance: Its distributions.
        shares: Draws in [0, 1), (SHARES,).
        episode: EPISODE record; step_time, mass and friction are set already.
    """
    _ENTER[disturbance.kind](disturbance, shares.tolist(), episode)


def _step(episode: np.void, time: float) -> int:
    return round(time / float(episode["step_time"]))


def _push(push: Push, shares: list[float], episode: np.void) -> None:
    begin = _step(episode, push.time.at(shares[0]))
    steps = max(1, _step(episode, push.duration.at(shares[1])))
    force = push.impulse.at(shares[2]) / (steps * float(episode["step_time"]))
    heading, lever = push.direction.at(shares[3]), push.lever.at(shares[4])
    k = int(episode["pushes"])
    episode["push_start"][k], episode["push_end"][k] = begin, begin + steps
    episode["push_wrench"][k] = force * math.cos(heading), force * math.sin(heading), force * lever
    episode["pushes"] = k + 1


def _shake(shake: Shake, shares: list[float], episode: np.void) -> None:
    along, pitch = shake.amplitude.at(shares[0]), shake.pitch.at(shares[1])
    omega = [math.tau * shake.frequency.at(share) for share in shares[2:5]]
    phase = [math.tau * share for share in shares[5:8]]
    episode["shakes"][1] = np.column_stack(([along, along, pitch], omega, phase))


def _mass_change(change: MassChange, shares: list[float], episode: np.void) -> None:
    episode["mass_step"] = _step(episode, change.time.at(shares[0]))
    episode["mass_factor"] = change.factor.at(shares[1])


def _friction_jump(jump: FrictionJump, shares: list[float], episode: np.void) -> None:
    episode["jump_step"] = _step(episode, jump.time.at(shares[0]))
    episode["jump_factor"] = jump.factor.at(shares[1])


def _patch(patch: Patch, shares: list[float], episode: np.void) -> None:
    start = patch.start.at(shares[0])
    episode["patch"] = start, start + patch.length.at(shares[1])
    episode["patch_factor"] = patch.factor.at(shares[2])


_ENTER: dict[str, Any] = {
    "push": _push,
    "shake": _shake,
    "mass_change": _mass_change,
    "friction_jump": _friction_jump,
    "patch": _patch,
}
