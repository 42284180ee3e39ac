"""The environments."""

from slipgym.envs.hold import HoldEnv
from slipgym.envs.linear_slip import LinearSlipEnv

__all__ = ["HoldEnv", "LinearSlipEnv"]
