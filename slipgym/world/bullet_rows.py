"""The compiled functions that a single world in PyBullet calls, on the first row of its arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from slipgym._numba.calls import direct_call
from slipgym._numba.compiled import compiled
from slipgym._numba.fixed import Fixed, opened
from slipgym._numba.rows import row_of
from slipgym.contact.records import Vector
from slipgym.world.actuator import queue_command
from slipgym.world.bullet_coupling import engine_loads
from slipgym.world.bullet_coupling import read_engine as coupled_reading
from slipgym.world.plant import Plant
from slipgym.world.substep import update_slip
from slipgym.world.tilt_coupling import tilted_loads as coupled_loads

VECTOR, PAIR = types.UniTuple(types.float64, 3), types.UniTuple(types.float64, 2)
POSE = types.Tuple([VECTOR, types.UniTuple(types.float64, 4)])
"""Types of what the engine is read into."""


@compiled
def loads(
    fixed: Fixed, pose: tuple, velocity: tuple, wrist: Vector, normals: tuple[float, float]
) -> tuple[Any, ...]:
    """`engine_loads` of the first world; `fixed` has the arrays that it takes first."""
    worlds, pads, cells, fingers, force_torque, slip_sensors = opened(fixed)
    return engine_loads(
        worlds[0],
        pads[0],
        row_of(cells, 0),
        fingers[0],
        force_torque[0],
        slip_sensors[0],
        pose[0],
        pose[1],
        velocity[0],
        velocity[1],
        wrist,
        normals,
    )


@compiled
def tilted_loads(fixed: Fixed, pose: tuple, velocity: tuple, wrist: Vector) -> tuple[Any, ...]:
    """`slipgym.world.tilt_coupling.tilted_loads` of the first world; `fixed` has the arrays, tilts last."""
    worlds, pads, cells, fingers, force_torque, slip_sensors, tilts = opened(fixed)
    return coupled_loads(
        worlds[0],
        tilts[0],
        pads[0],
        row_of(cells, 0),
        fingers[0],
        force_torque[0],
        slip_sensors[0],
        pose[0],
        pose[1],
        velocity[0],
        velocity[1],
        wrist,
    )


@compiled
def read_engine(
    worlds: np.ndarray, fingers: np.ndarray, pose: tuple, wrist: Vector, normals: tuple[float, float]
) -> None:
    """`read_engine` of the first world, and its slip."""
    coupled_reading(worlds[0], fingers[0], pose[0], pose[1], wrist, normals)
    update_slip(worlds[0])


@compiled
def queue(worlds: np.ndarray, fingers: np.ndarray, force: float) -> None:
    """`queue_command` of both fingers of the first world [N]."""
    for f in range(2):
        queue_command(fingers[0, f], worlds[0].tick, force)


class BulletRows:
    """These functions, compiled for the arrays of one world and called without numba's dispatch.

    Args:
        plant: The arrays, which must stay the same.

    Attributes:
        loads: Takes the arguments of `loads` after the first; those of `tilted_loads` with `physics.tilt`.
        queue: Takes the grip force [N].
    """

    def __init__(self, plant: Plant) -> None:
        function: Any = loads
        arrays: tuple[Any, ...] = (
            plant.world,
            plant.pads,
            plant.cells,
            plant.fingers,
            plant.force_torque,
            plant.slip_sensors,
        )
        readings: list[Any] = [POSE, types.UniTuple(VECTOR, 2), VECTOR, PAIR]
        if plant.tilt is not None:
            function, arrays = tilted_loads, (*arrays, plant.tilt)
            readings.pop()
        self.loads = direct_call(function, (Fixed(arrays),), *readings)
        self.queue = direct_call(queue, (plant.world, plant.fingers), types.float64)
