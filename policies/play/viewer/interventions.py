"""Changes to a running episode, written into its disturbances.

They act from the next control step on, by the code that applies sampled disturbances
(`slipgym/tasks/disturbance.py`), on both engines alike. A value that is not positive and finite raises
ValueError.
"""

from __future__ import annotations

import math
from numbers import Real

import numpy as np

POKE_TIME = 0.05
"""Duration of a poke [s]."""
LEVER = 0.05
"""Distance between the two forces of a couple that turns the object [m]."""
DIRECTIONS: dict[str, tuple[float, float, float]] = {
    "←": (-1.0, 0.0, 0.0),
    "↑": (0.0, 1.0, 0.0),
    "↓": (0.0, -1.0, 0.0),
    "→": (1.0, 0.0, 0.0),
    "↺": (0.0, 0.0, LEVER),
    "↻": (0.0, 0.0, -LEVER),
}
"""Name -> impulse (x, z, turn) for a magnitude of 1 N s [N s, N s, N m s]."""
PUSHES, TURNS = tuple(DIRECTIONS)[:4], tuple(DIRECTIONS)[4:]


def set_friction(episode: np.void, mu_c: float) -> None:
    """Set Coulomb friction > 0, which drift and `finger_friction` multiply; it replaces the friction jump.

    Static friction keeps its ratio, drift and surface regions stay.
    """
    episode["jump_factor"] = checked("mu_c", mu_c) / float(episode["mu_c"])
    episode["jump_step"] = episode["step"]


def set_mass(episode: np.void, mass: float) -> None:
    """Set the object's mass > 0 [kg], with its inertia; it replaces the episode's change of mass."""
    episode["mass_factor"] = checked("mass", mass) / float(episode["mass"])
    episode["mass_step"] = episode["step"]


def poke(episode: np.void, direction: str, impulse: float) -> None:
    """Push the object at its centre of mass, or turn it, for `POKE_TIME`, with an impulse > 0 [N s].

    Raises:
        ValueError: The direction is none of `DIRECTIONS`.
    """
    if not isinstance(direction, str) or direction not in DIRECTIONS:
        raise ValueError(f"unknown direction {direction!r}; valid: {', '.join(DIRECTIONS)}")
    now, count = int(episode["step"]), int(episode["pushes"])
    steps = max(1, round(POKE_TIME / float(episode["step_time"])))
    force = checked("impulse", impulse) / (steps * float(episode["step_time"]))
    wrench = np.multiply(force, DIRECTIONS[direction])
    full = count == len(episode["push_start"])
    first = int(np.argmin(episode["push_end"]))
    for name, value in (("push_start", now), ("push_end", now + steps), ("push_wrench", wrench)):
        if full:  # the push that ends first makes room
            episode[name][first:-1] = episode[name][first + 1 :].copy()
        episode[name][count - full] = value
    episode["pushes"] = count - full + 1


def checked(name: str, value: float) -> float:
    """Returns a value that acts on the object or the gripper."""
    if isinstance(value, bool) or not isinstance(value, Real) or not 0.0 < value < math.inf:
        raise ValueError(f"{name} = {value!r} must be positive and finite")
    return float(value)
