"""Changes to a running episode, written into its disturbances.

They act from the next control step on, by the code that applies sampled disturbances
(`slipgym/tasks/disturbance.py`), on both engines alike.
"""

from __future__ import annotations

import math
from numbers import Real

import numpy as np

POKE_TIME = 0.05
"""Duration of a poke [s]."""
LEVER = 0.05
"""Distance between the two forces of a couple that turns the object [m]."""
PUSHES, TURNS = ("←", "↑", "↓", "→"), ("↺", "↻")
_IMPULSES = (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0)
DIRECTIONS: dict[str, tuple[float, float, float]] = {
    **dict(zip(PUSHES, _IMPULSES, strict=True)),
    TURNS[0]: (0.0, 0.0, LEVER),
    TURNS[1]: (0.0, 0.0, -LEVER),
}
"""Name -> impulse (x, z, turn) for a magnitude of 1 N s [N s, N s, N m s]."""


def set_friction(episode: np.void, mu_c: float) -> None:
    """Set Coulomb friction to a value; static friction keeps its ratio, drift and surface regions stay.

    It replaces the episode's friction jump, if there is one.

    Args:
        episode: EPISODE record, written into.
        mu_c: Coulomb friction, > 0; drift and `finger_friction` multiply it [-].

    Raises:
        ValueError: The value is not positive and finite.
    """
    episode["jump_factor"] = checked("mu_c", mu_c) / float(episode["mu_c"])
    episode["jump_step"] = episode["step"]


def set_mass(episode: np.void, mass: float) -> None:
    """Set the object's mass, with its inertia; it replaces the episode's change of mass, if there is one.

    Args:
        episode: EPISODE record, written into.
        mass: > 0 [kg].

    Raises:
        ValueError: The value is not positive and finite.
    """
    episode["mass_factor"] = checked("mass", mass) / float(episode["mass"])
    episode["mass_step"] = episode["step"]


def poke(episode: np.void, direction: str, impulse: float) -> None:
    """Push the object at its centre of mass, or turn it, for `POKE_TIME`.

    Args:
        episode: EPISODE record, written into.
        direction: One of `DIRECTIONS`.
        impulse: Magnitude, > 0 [N s].

    Raises:
        ValueError: The direction is unknown, or the impulse is not positive and finite.
    """
    if not isinstance(direction, str) or direction not in DIRECTIONS:
        raise ValueError(f"unknown direction {direction!r}; valid: {', '.join(DIRECTIONS)}")
    now, count = int(episode["step"]), int(episode["pushes"])
    steps = max(1, round(POKE_TIME / float(episode["step_time"])))
    force = checked("impulse", impulse) / (steps * float(episode["step_time"]))
    fields = "push_start", "push_end", "push_wrench"
    if count == len(episode["push_start"]):  # the list is full: the push that ends first makes room
        first = int(np.argmin(episode["push_end"]))
        for name in fields:
            episode[name][first:-1] = episode[name][first + 1 :].copy()
        count -= 1
    for name, value in zip(
        fields, (now, now + steps, np.multiply(force, DIRECTIONS[direction])), strict=True
    ):
        episode[name][count] = value
    episode["pushes"] = count + 1


def checked(name: str, value: float) -> float:
    """Returns a value that acts on the object or the gripper.

    Raises:
        ValueError: It is no number, or not positive and finite.
    """
    if isinstance(value, bool) or not isinstance(value, Real) or not 0.0 < value < math.inf:
        raise ValueError(f"{name} = {value!r} must be positive and finite")
    return float(value)
