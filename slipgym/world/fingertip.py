"""Adds to a force/torque sensor's load the weight and inertia of the fingertip in front of it.

Such a sensor reads m (g - a) beside the load on the pad, with m the mass between it and the object, g gravity
and a the acceleration of the pad centre, where the mass is taken to be (for tools at a wrist: Shaker & Erden,
arXiv 2604.23696). Only the part in the contact plane counts; it turns with the wrist's pitch.
"""

from __future__ import annotations

from typing import Any

from slipgym._numba.compiled import compiled
from slipgym.contact.records import Pad
from slipgym.sensors.force_torque import sample_force_torque
from slipgym.sensors.structure import vibrate
from slipgym.world.object_motion import pad_axes
from slipgym.world.records import World


@compiled
def weigh_tip(sensor: Any, world: World) -> None:
    """Set `tip_load` of a FORCE_TORQUE record to weight and inertia of its fingertip now."""
    cos, sin = pad_axes(world)
    x, z = -world.wrist_acceleration[0], -world.gravity - world.wrist_acceleration[1]
    sensor.tip_load[0] = sensor.tip_mass * (cos * x + sin * z)
    sensor.tip_load[1] = sensor.tip_mass * (cos * z - sin * x)


@compiled
def sample_finger(sensor: Any, pad: Pad, world: World) -> None:
    """`sample_force_torque` of a finger whose tip has a mass and may vibrate, at the world's time."""
    sample_force_torque(sensor, pad, world.tick)
    if sensor.tip_mass > 0.0:
        weigh_tip(sensor, world)
        load = sensor.history[(world.tick // sensor.period) % sensor.kept]
        load[0] += sensor.tip_load[0]
        load[1] += sensor.tip_load[1]
    if sensor.mode[0] > 0.0:
        vibrate(sensor, sensor.history[(world.tick // sensor.period) % sensor.kept])
