"""RotationalSlip-v0."""

from __future__ import annotations

from slipgym.envs.slip_env import SlipEnv
from slipgym.tasks import TASKS


class RotationalSlipEnv(SlipEnv):
    """TODO."""

    task = TASKS["RotationalSlip"]
