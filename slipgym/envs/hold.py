"""Hold-v0."""

from __future__ import annotations

from slipgym.envs.slip_env import SlipEnv
from slipgym.tasks import TASKS


class HoldEnv(SlipEnv):
    """Hold an object of unknown mass and friction while the wrist shakes and pokes disturb it."""

    task = TASKS["Hold"]
