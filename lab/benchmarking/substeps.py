"""Measures the CPU time of one planar sub-step of a held box: firm stick, steady slide, stick-slip.

Sub-steps are repeated in a compiled loop on the records of a reset environment, without the engine. The
process's CPU time counts: other work on the machine then costs cache, but no time of its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from functools import partial
from statistics import median
from time import process_time
from typing import Any

import numpy as np

from lab.benchmarking.measure import OPTIONS, Player
from lab.benchmarking.timing import compare
from slipgym._numba.compiled import compiled
from slipgym.benchmarking.report import Figure
from slipgym.world.plant import Plant
from slipgym.world.substep import substep

STEPS = 4000  # sub-steps in a block
STICK, SLIDE = 15.0, 1.2  # grip force [N]
SPEED = 0.02  # of the slide [m/s]
MODULATION, PERIOD = 0.5, 0.1  # of the grip force about the sliding limit [-, s]


@compiled
def repeat(world, pads, cells, fingers, slip_sensors, forces, steps):
    """Sub-steps of the longest length; the commanded grip forces [N] come round and round."""
    h = world.substep_ticks * world.tick_length
    fraction = world.substep_ticks / world.engine_ticks
    gripper = (pads[0], pads[1]), cells, (fingers[0], fingers[1]), (slip_sensors[0], slip_sensors[1])
    for k in range(steps):
        for f in range(2):
            fingers[f].command = forces[k % forces.shape[0]]
        substep(world, *gripper, h, fraction)


def held(plant: Plant, force: float, speed: float = 0.0, load: float = 0.0) -> Plant:
    """A copy of a plant whose box is held by a force and slides down at a speed.

    Args:
        plant: A box at rest between the pads, n = 1.
        force: Grip force per finger [N].
        speed: Of the box [m/s], down.
        load: On its centre of mass [N], up.
    """
    plant = deepcopy(plant)
    for field in ("contact_force", "contact_mean_force", "force", "command"):
        plant.fingers[field] = force
    plant.world["velocity"][:, 1] -= speed
    plant.world["external"][:, 1] = load
    return plant


def regimes(plant: Plant) -> Iterator[tuple[str, Plant, np.ndarray]]:
    """Name, start and commanded grip forces [N] of each regime."""
    weight = (plant.world["mass"] * plant.world["gravity"]).item()
    mu_c, sigma_2 = (plant.pads[field][0, 0].item() for field in ("mu_c", "sigma_2"))
    yield "stick", held(plant, STICK), np.array([STICK])
    level = mu_c + sigma_2 * SPEED
    balance = weight - 2.0 * level * SLIDE
    yield "slide", held(plant, SLIDE, SPEED, balance), np.array([SLIDE])
    limit = weight / (2.0 * mu_c)
    length = round(PERIOD / (plant.world["substep_ticks"] * plant.world["tick_length"]).item())
    wave = 1.0 + MODULATION * np.sin(2.0 * np.pi * np.arange(length) / length)
    yield "stick-slip", held(plant, limit), limit * wave


def block(start: Plant, forces: np.ndarray, run: Any = repeat) -> tuple[float, int]:
    """CPU time [s] and number of sub-steps from a start."""
    plant = deepcopy(start)
    cells = None if plant.cells is None else plant.cells[0]
    before = process_time()
    run(plant.world[0], plant.pads[0], cells, plant.fingers[0], plant.slip_sensors[0], forces, STEPS)
    return process_time() - before, STEPS


def softer(env_id: str, pairs: int) -> list[Figure]:
    """Time of a sub-step with the disc and with soft pads over that of hard ellipsoids, in turns."""
    plants = {}
    for name, arguments in {"hard": {}, **{key: OPTIONS[key] for key in ("disc", "soft pads")}}.items():
        player = Player(env_id, **arguments)
        plants[name] = deepcopy(player.rest())
        player.env.close()
    figures = []
    for kind in ("disc", "soft pads"):
        pair = zip(regimes(plants["hard"]), regimes(plants[kind]), strict=True)
        for (name, hard, forces), (_, soft, others) in pair:
            result = compare(partial(block, hard, forces), partial(block, soft, others), pairs)
            figures.append(Figure(f"sub-step, {name}, {kind} / hard", result.quartiles[1], "-"))
    return figures


def substeps(plant: Plant, repeats: int) -> list[Figure]:
    """Median time of a sub-step in each regime."""
    figures = []
    for name, start, forces in regimes(plant):
        measured = partial(block, start, forces)
        measured()  # warm up
        times = [seconds / steps for seconds, steps in (measured() for _ in range(repeats))]
        figures.append(Figure(f"sub-step, {name}", 1e9 * median(times), "ns"))
    return figures
