"""Measures the memory per environment: of a vector environment, and of single ones with PyBullet."""

from __future__ import annotations

import os
from dataclasses import fields
from pathlib import Path

import gymnasium as gym

from slipgym.envs.vector_env import SlipVectorEnv


def bytes_per_environment(env: SlipVectorEnv) -> float:
    """Bytes of all arrays that last from step to step, over the number of environments.

    Python's own objects come on top: a random generator, the description of the box, the name of the
    material and what the randomization drew.
    """
    state = env.get_state()
    plant = [getattr(state.simulation.plant, field.name) for field in fields(state.simulation.plant)]
    arrays = [*plant, *state.simulation.arrays.values(), state.frames]
    return sum(array.nbytes for array in arrays if array is not None) / env.num_envs


def bytes_with_pybullet(env_id: str = "slipgym/LinearSlip-v0", count: int = 20) -> float:
    """Resident bytes that one more environment with PyBullet takes, mean over some; on Linux.

    Args:
        env_id: Id of the environments.
        count: How many are made, after a first one that loads the programs.
    """
    envs, before = [], 0.0
    for k in range(count + 1):
        envs.append(gym.make(env_id, disable_env_checker=True))
        envs[-1].reset(seed=k)
        before = before or _resident()
    grown = _resident() - before
    for env in envs:
        env.close()
    return grown / count


def _resident() -> float:
    """Resident memory of this process [bytes]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return float(pages * os.sysconf("SC_PAGE_SIZE"))
