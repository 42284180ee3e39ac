"""The environments."""

from slipgym.envs.hinge import HingeEnv
from slipgym.envs.hold import HoldEnv
from slipgym.envs.linear_slip import LinearSlipEnv
from slipgym.envs.planar_slip import PlanarSlipEnv
from slipgym.envs.rotational_slip import RotationalSlipEnv

__all__ = ["HingeEnv", "HoldEnv", "LinearSlipEnv", "PlanarSlipEnv", "RotationalSlipEnv"]
