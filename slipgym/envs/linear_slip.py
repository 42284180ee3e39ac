"""LinearSlip-v0."""

from __future__ import annotations

from slipgym.envs.slip_env import SlipEnv
from slipgym.tasks import TASKS


class LinearSlipEnv(SlipEnv):
    """Let an object slide a given distance along gravity in a given time, then hold it."""

    task = TASKS["LinearSlip"]
