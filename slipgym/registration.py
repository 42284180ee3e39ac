"""Registers the environments with Gymnasium. Imports nothing heavy: environments load on `make`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import gymnasium as gym
from gymnasium.envs.registration import parse_env_id

if TYPE_CHECKING:
    from slipgym.envs.slip_env import SlipEnv
    from slipgym.tasks import Task

TASK_MODULES = {
    "slipgym/LinearSlip-v0": "slipgym.tasks.linear_slip",
    "slipgym/RotationalSlip-v0": "slipgym.tasks.rotational_slip",
    "slipgym/Hinge-v0": "slipgym.tasks.hinge",
    "slipgym/PlanarSlip-v0": "slipgym.tasks.planar_slip",
    "slipgym/Hold-v0": "slipgym.tasks.hold",
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


def register_task(task: Task) -> type[SlipEnv]:
    """Make a task of your own an environment, in this process.

    Bind the class that comes back to a name of the module that defines the task, <name>Env: Gymnasium looks
    for it there, and so does pickle. Once registered, a task is in `slipgym.tasks.TASKS`, its settings are in
    the configuration, and experiments, policies and pictures know it. Registering an id again replaces the
    task.

    Args:
        task: The task; the module is that of its `start`.

    Raises:
        ValueError: Another task has its name or key, or a part of it is not as it should be; the message says
            which.
    """
    from slipgym.envs.environment import environment
    from slipgym.tasks.table import add

    made = environment(task)
    add(task)
    gym.registry.pop(task.id, None)
    register_id(task.id, f"{made.__module__}:{made.__name__}")
    return made
