"""Registers the environments with Gymnasium. Imports nothing heavy: environments load on `make`."""

from __future__ import annotations

import gymnasium as gym

ENVIRONMENTS = {
    "slipgym/LinearSlip-v0": "slipgym.envs:LinearSlipEnv",
    "slipgym/RotationalSlip-v0": "slipgym.envs:RotationalSlipEnv",
    "slipgym/Hinge-v0": "slipgym.envs:HingeEnv",
    "slipgym/PlanarSlip-v0": "slipgym.envs:PlanarSlipEnv",
    "slipgym/Hold-v0": "slipgym.envs:HoldEnv",
}
"""Id -> entry point."""


def register() -> None:
    """Register every id; doing so twice changes nothing.

    Episodes end by themselves (`truncated`), so no TimeLimit is asked for.
    """
    for name, entry_point in ENVIRONMENTS.items():
        if name not in gym.registry:
            gym.register(id=name, entry_point=entry_point)
