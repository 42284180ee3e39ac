"""Applies velocity commands to the wrist, within the gripper's limits."""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled
from slipgym.world.records import Tilt, World


@compiled
def ramp_wrist(
    world: World, x: float, z: float, pitch: float, speed_max: float, pitch_rate_max: float, duration: float
) -> None:
    """Ramp the wrist's velocity to a target (x, z, pitch) within a duration [m/s, m/s, rad/s, s].

    The target is brought down to `speed_max`, direction of (x, z) kept, and to `pitch_rate_max`.
    """
    fraction = 1.0
    if abs(x) + abs(z) > 0.999 * speed_max:  # the length costs more
        fraction = min(1.0, speed_max / max(math.hypot(x, z), 1e-12))
    rate = min(max(pitch, -pitch_rate_max), pitch_rate_max)
    world.wrist_acceleration[0] = (fraction * x - world.wrist_velocity[0]) / duration
    world.wrist_acceleration[1] = (fraction * z - world.wrist_velocity[1]) / duration
    world.wrist_acceleration[2] = (rate - world.wrist_velocity[2]) / duration


@compiled
def ramp_tilt(
    tilt: Tilt, roll_rate: float, sway: float, rate_max: float, speed_max: float, duration: float
) -> None:
    """Ramp the wrist's roll rate [rad/s] and its velocity along +y [m/s] to a target within a duration [s].

    +y is the grip axis from finger 2 to finger 1. The target is brought down to `rate_max` and `speed_max`.
    """
    roll_rate = min(max(roll_rate, -rate_max), rate_max)
    sway = min(max(sway, -speed_max), speed_max)
    tilt.roll[2] = (roll_rate - tilt.roll[1]) / duration
    tilt.sway[2] = (sway - tilt.sway[1]) / duration
