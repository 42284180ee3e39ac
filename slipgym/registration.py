"""Registers the environments with Gymnasium. Imports nothing heavy: environments load on `make`."""

from __future__ import annotations

import gymnasium as gym
from gymnasium.envs.registration import parse_env_id

TASK_MODULES = {
    "slipgym/LinearSlip-v0": "slipgym.tasks.linear_slip",
    "slipgym/RotationalSlip-v0": "slipgym.tasks.rotational_slip",
    "slipgym/Hinge-v0": "slipgym.tasks.hinge",
    "slipgym/PlanarSlip-v0": "slipgym.tasks.planar_slip",
    "slipgym/Hold-v0": "slipgym.tasks.hold",
    "slipgym/FragileHold-v0": "slipgym.tasks.fragile_hold",
    "slipgym/Carry-v0": "slipgym.tasks.carry",
    "slipgym/Explore-v0": "slipgym.tasks.explore",
    "slipgym/PivotTo-v0": "slipgym.tasks.pivot_to",
}
"""Id -> module that holds its TASK. A task that comes with slipgym is one such module and its row here."""

ENVIRONMENTS = {name: f"slipgym.envs:{parse_env_id(name)[1]}Env" for name in TASK_MODULES}
"""Id -> entry point."""


def register() -> None:
    """Register every id; doing so twice changes nothing.

    Episodes end by themselves (`truncated`), so no TimeLimit is asked for.
    """
    for name, entry_point in ENVIRONMENTS.items():
        if name not in gym.registry:
            register_id(name, entry_point)


def register_id(name: str, entry_point: str) -> None:
    """Register an id with its environment and its batch."""
    batch = f"slipgym.envs.vector_env:{parse_env_id(name)[1]}VectorEnv"
    gym.register(id=name, entry_point=entry_point, vector_entry_point=batch)
