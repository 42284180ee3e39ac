"""The rules for the state of a simulation, and the checks that compare several of its fields."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from estimator.state_checks import ranges
from slipgym.contact.records import ELASTIC_LIMIT, SPEED_CAP
from slipgym.envs.record_checks import (
    COUNT,
    Rules,
    check_array,
    check_between,
    check_finite,
    check_records,
    damaged,
)
from slipgym.sensors.slip_velocity import CHIPS_MAX, HISTORY
from slipgym.tasks.disturbance import PUSHES_MAX
from slipgym.world.plant import Plant
from slipgym.world.records import QUEUE
from slipgym.world.scene import Box
from slipgym.world.snapshot import EngineState

_SCALES = 1e-3, 1e3
"""Friction over that at the reference force, at a millionth and a million times it, load exponent 1/2."""
_PLANT = {
    "world": Rules(fixed=("tick_length", "control_ticks", "engine_ticks", "substep_ticks", "calm_ticks")),
    "pads": Rules(
        fixed=(
            *("surface", "stribeck_exponent", "sigma_1", "sigma_2", "reference_force", "radius_max"),
            *("shear_time", "creep_time", "aging_time", "aging_distance"),
        ),
        ranges={"stuck": (0, 1)},
    ),
    "fingers": Rules(fixed=("force_limit", "open_below"), free=("queue_tick",)),
    "force_torque": Rules(
        fixed=(
            *("period", "mirror", "drift", "resolution", "range", "misaligned", "off_centre", "tilt"),
            *("crosstalk", "least_delay", "delay_spread", "dropout", "kept"),
        ),
        free=("key", "drift_key"),
    ),
    "slip_sensors": Rules(
        fixed=(
            *("mirror", "sample_time", "count", "range", "window", "delay_spread", "jitter", "dropout"),
            *("scale_spread", "chip_failure", "chips", "at", "spread"),
        ),
        ranges={"failed": (-1, CHIPS_MAX - 1), "delivered": (-1, COUNT)},
        free=("key",),
    ),
    "tilt": Rules(
        fixed=("stiffness", "relaxation", "pad_radius", "jaw_mass", "jaw_damping", "gravity"),
    ),
}
"""Array of a `Plant` -> its rules."""
_ARRAYS = {
    "estimates": Rules(),
    "episode": Rules(
        fixed=(
            *("step_time", "force_min", "force_max", "wrist_speed_max", "wrist_pitch_rate_max"),
            *("pad_radius", "scales"),
        ),
        ranges={"pushes": (0, PUSHES_MAX)},
        free=("mass_step", "jump_step", "push_start", "push_end"),
    ),
}
"""Array of a simulation -> its rules; the others are plain numbers."""
RULES = {**_PLANT, **_ARRAYS}
"""Array of records -> its rules."""


def check_plant(given: Any, own: Plant, rows: np.ndarray) -> None:
    """Check worlds, pads, fingers and sensors.

    Args:
        given: The `Plant` of a state.
        own: The environment's.
        rows: Environments that have an episode, (n,) bool; those of the others are not read.

    Raises:
        ValueError: They are not what an environment like this can have written.
    """
    if type(given) is not Plant:
        raise damaged(f"plant must be a Plant, got {type(given).__name__}")
    found = {}
    for name in (field.name for field in fields(Plant)):
        array, mine = getattr(given, name), getattr(own, name)
        if (array is None) != (mine is None):
            raise damaged(f"plant.{name}: {'missing' if array is None else 'the environment has none'}")
        if name == "cells" and mine is not None:
            _check_cells(array, mine, rows)
        elif mine is not None:
            found[name] = check_records(f"plant.{name}", array, mine, _PLANT[name], rows)
    _check_gravity(found["world"]["gravity"], own, rows)
    check_between("plant.pads.friction_scale", found["pads"]["friction_scale"], *_SCALES)
    _check_fingers(found["fingers"], found["world"]["control_ticks"])
    _check_sensors(found["force_torque"], found["slip_sensors"])


def _check_gravity(gravity: np.ndarray, own: Plant, rows: np.ndarray) -> None:
    """Gravity in the contact plane is the environment's; roll of the wrist makes it smaller."""
    if own.tilt is None:
        least = most = own.world["gravity"][rows]
    else:
        most = np.abs(own.tilt["gravity"][rows])
        least = -most
    check_between("plant.world.gravity", gravity, least, most)


def _check_cells(array: Any, own: np.ndarray, rows: np.ndarray) -> None:
    cells = check_array("plant.cells", array, own.dtype, own.shape)[rows]
    if np.isnan(cells).any():
        raise damaged("plant.cells holds a number that is not finite")
    if own.ndim > 3:  # patches
        others = np.delete(cells, (SPEED_CAP, ELASTIC_LIMIT), axis=2)
        check_finite("plant.cells", others)


def _check_fingers(fingers: np.ndarray, control_ticks: np.ndarray) -> None:
    waiting = fingers["queued"] - fingers["served"]
    check_between("plant.fingers.queued - served", waiting, 0, QUEUE)
    longest = np.broadcast_to(QUEUE * control_ticks[:, np.newaxis], waiting.shape)
    check_between("plant.fingers.dead_ticks", fingers["dead_ticks"], 0, longest)


def _check_sensors(wrench: np.ndarray, slip: np.ndarray) -> None:
    for name, sensor in (("force_torque", wrench), ("slip_sensors", slip)):
        least = sensor["least_delay"]
        check_between(f"plant.{name}.delay", sensor["delay"], least, least + sensor["delay_spread"])
    oldest = slip["window"] + slip["least_delay"] + slip["delay_spread"] + (slip["jitter"] > 0.0)
    check_between("plant.slip_sensors.least_delay", oldest, 0, HISTORY - 1)
    check_between("plant.slip_sensors.failed", slip["failed"], -1, slip["chips"] - 1)
    check_between("plant.slip_sensors.delivered", slip["delivered"], -1, slip["taken"] - 1)


def check_arrays(
    given: Any, own: Mapping[str, np.ndarray], blank: np.ndarray, estimator: str, rows: np.ndarray
) -> None:
    """Check estimators, episodes, and their last outputs.

    Args:
        given: The arrays of a state, by name.
        own: Those of the environment.
        blank: EPISODE (1,) with the values that all episodes begin with.
        estimator: Name of the estimator.
        rows: Environments that have an episode, (n,) bool.

    Raises:
        ValueError: They are not what an environment like this can have written.
    """
    if not isinstance(given, Mapping) or set(given) != set(own):
        raise damaged(f"arrays must be a mapping with the keys {', '.join(sorted(own))}")
    fixed = Rules(fixed=own["estimator_parameters"].dtype.names or ())
    # what else an estimator's state holds is its own affair: none of it is an index
    indices = Rules(ranges=ranges(estimator), counters=False, finite=False)
    rules = {**_ARRAYS, "estimator_parameters": fixed, "estimator_states": indices}
    for name, mine in own.items():
        array, some = given[name], rows
        if name == "estimator_parameters":
            some = np.ones(len(mine), dtype=bool)
        elif len(mine) > len(rows):  # a row per finger
            some = np.repeat(rows, len(mine) // len(rows))
        if name in rules:
            reference = np.repeat(blank, len(mine)) if name == "episode" else mine
            check_records(name, array, reference, rules[name], some)
        else:
            check_finite(name, check_array(name, array, mine.dtype, mine.shape)[some])
    check_between("episode.steps", given["episode"]["steps"][rows], 1, COUNT)


def check_objects(materials: Any, boxes: Any, known: Mapping[str, Any], rows: np.ndarray) -> None:
    """Check names of materials and objects of the episodes.

    Raises:
        ValueError: They are not what an environment like this can have written.
    """
    for name, listed in (("materials", materials), ("boxes", boxes)):
        if not isinstance(listed, list | tuple) or len(listed) != len(rows):
            raise damaged(f"{name} must be a list of {len(rows)}")
    for i in np.flatnonzero(rows).tolist():
        if materials[i] not in known:
            raise damaged(f"materials[{i}] = {materials[i]!r:.80} is unknown")
        check_box(f"boxes[{i}]", boxes[i])


def check_box(name: str, box: Any) -> None:
    """Raise ValueError if this is no box, or one of no extent or mass."""
    if type(box) is not Box:
        raise damaged(f"{name} must be a Box, got {type(box).__name__}")
    check_numbers(f"{name}.size", box.size, 3, least=1e-9)
    check_numbers(f"{name}.com_offset", box.com_offset, 2)
    check_numbers(f"{name}.grasp_offset", box.grasp_offset, 2)
    check_numbers(f"{name}.mass, inertia", (box.mass, box.inertia), 2, least=1e-12)


def check_numbers(name: str, given: Any, count: int, least: float = -1e9) -> None:
    """Raise ValueError if these are not so many numbers from `least` to 1e9, as a tuple."""
    sound = isinstance(given, tuple) and len(given) == count
    if not sound or not all(type(x) in (float, int) and least <= x <= 1e9 for x in given):
        raise damaged(f"{name} must be {count} numbers from {least:g} to 1e+09, got {given!r:.80}")


def check_engine(given: Any, box: Box) -> None:
    """Check PyBullet's part of a state; what its own file holds, `slipgym.world.snapshot` tries.

    Args:
        given: The `EngineState` of a state.
        box: The object of the episode.

    Raises:
        ValueError: It is not what an environment can have written.
    """
    if type(given) is not EngineState:
        raise damaged(f"engine must be an EngineState, got {type(given).__name__}")
    check_box("engine.box", given.box)
    if (given.box.size, given.box.com_offset, given.box.grasp_offset) != (
        *(box.size, box.com_offset, box.grasp_offset),
    ):
        raise damaged("engine.box is another one than boxes[0]")
    if not isinstance(given.engine, bytes):
        raise damaged(f"engine.engine must be bytes, got {type(given.engine).__name__}")
    reading = given.reading
    if not isinstance(reading, tuple) or len(reading) != 5 or not all(len(reading[k]) == 2 for k in (0, 1)):
        raise damaged("engine.reading must have five parts")
    (place, attitude), (linear, angular), wrist, normals, speeds = reading
    parts = place, attitude, linear, angular, wrist, normals, speeds
    for part, count in zip(parts, (3, 4, 3, 3, 3, 2, 5), strict=True):
        check_numbers("engine.reading", part, count)
