"""Measures the memory that an environment with PyBullet takes."""

from __future__ import annotations

import os
from pathlib import Path

import gymnasium as gym


def bytes_with_pybullet(env_id: str = "slipgym/LinearSlip-v0", count: int = 20) -> float:
    """Resident bytes that one more environment with PyBullet takes, mean over some; on Linux.

    Args:
        env_id: Id of the environments.
        count: How many are made, after a first one that loads the programs.
    """
    envs, before = [], 0.0
    for k in range(count + 1):
        envs.append(gym.make(f"slipgym:{env_id}", disable_env_checker=True))
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
