"""Computes normal forces from the momentum of the fingers."""

from __future__ import annotations

from slipgym.world.actuator import FINGER_DAMPING

_LEAST = 1e-9  # [N]; less is rounding of a finger that touches nothing


def normal_forces(
    efforts: tuple[float, float], before: tuple[float, ...], after: tuple[float, ...], inertia: float
) -> tuple[float, float]:
    """Normal forces of the contacts in the last engine step [N].

    They equal the sums over the engine's contact points, to rounding, and take less time to read.

    Args:
        efforts: Of the fingers in the step [N].
        before: Speeds of all joints at its start, with which the engine damps [m/s or rad/s].
        after: And at its end [m/s or rad/s].
        inertia: Mass of a finger over the length of the step [kg/s].
    """
    first = efforts[0] - inertia * (after[3] - before[3]) - FINGER_DAMPING * before[3]
    second = efforts[1] - inertia * (after[4] - before[4]) - FINGER_DAMPING * before[4]
    return first if first > _LEAST else 0.0, second if second > _LEAST else 0.0
