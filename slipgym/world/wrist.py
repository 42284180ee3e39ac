"""Applies velocity commands to the wrist, within the gripper's limits."""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled
from slipgym.world.records import World


@compiled
def ramp_wrist(
    world: World, x: float, z: float, pitch: float, speed_max: float, pitch_rate_max: float, duration: float
) -> None:
    """Ramp the wrist's velocity to a target.

    Args:
        world: WORLD record.
        x: Target along world x [m/s].
        z: Target along world z [m/s].
        pitch: Target of the pitch rate [rad/s].
        speed_max: The target (x, z) is brought down to this, direction kept [m/s].
        pitch_rate_max: The target of the pitch rate is brought down to this [rad/s].
        duration: Length of the ramp [s].
    """
    fraction = min(1.0, speed_max / max(math.hypot(x, z), 1e-12))
    rate = min(max(pitch, -pitch_rate_max), pitch_rate_max)
    world.wrist_acceleration[0] = (fraction * x - world.wrist_velocity[0]) / duration
    world.wrist_acceleration[1] = (fraction * z - world.wrist_velocity[1]) / duration
    world.wrist_acceleration[2] = (rate - world.wrist_velocity[2]) / duration
