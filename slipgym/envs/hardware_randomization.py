"""Prepares pads, force loop and sensors of a plant for sampled parameters, which `equip` sets."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from slipgym.config import Config
from slipgym.contact.anisotropy import stretch
from slipgym.contact.records import CELL_FIELDS
from slipgym.envs.randomizer import Randomizer
from slipgym.envs.reset_kernels import HARDWARE
from slipgym.world.plant import (
    Plant,
    check_slip_latency,
    dead_ticks,
    patch_of,
    ticks_per_second,
    without_cells,
)


def prepare_hardware(config: Config, plant: Plant, randomizer: Randomizer) -> tuple[np.ndarray, np.ndarray]:
    """Check that a plant can hold what is sampled, and make room for it.

    Args:
        config: Configuration of the plant.
        plant: The plant as it was built; its patches are enlarged to the size of the largest one.
        randomizer: Samples the parameters.

    Returns:
        HARDWARE (1,), and the patch of each pressure profile (p, CELL_FIELDS, m), not stretched.

    Raises:
        ValueError: The plant's buffers do not hold the longest delays that may be sampled.
    """
    dead_ticks(config, randomizer.most("dead_time"), "randomization.dead_time")
    check_slip_latency(config, round(randomizer.most("slip_latency")), "randomization.slip_latency")
    sensor = config.sensors.force_torque
    tangential, normal, torque = sensor.bias_tangential, sensor.bias_normal, sensor.bias_torque
    hardware = np.zeros(1, HARDWARE)
    hardware["spread"] = tangential, tangential, normal, torque, torque, torque
    hardware["noise"] = plant.force_torque["noise"][0, 0]
    hardware["slip_noise"] = plant.slip_sensors["noise"][0, 0]
    hardware["clock"], hardware["randomized"] = ticks_per_second(config), randomizer.active
    if randomizer.soft and plant.cells is None:
        plant.cells = without_cells(len(plant.pads))
    if config.contact.model != "distributed":
        return hardware, np.zeros((0, CELL_FIELDS, 0))
    return hardware, _enlarge(plant, randomizer.variants)


def _enlarge(plant: Plant, variants: Mapping[str, Config]) -> np.ndarray:
    """Give a plant the patches of the first variant, in the size of the largest; returns all patches."""
    found = [patch_of(variant) for variant in variants.values()]
    patches = np.zeros((len(found), CELL_FIELDS, max(cells.shape[1] for cells in found)))
    for cells, own in zip(patches, found, strict=True):
        cells[:, : own.shape[1]] = own  # a cell of weight 0 does nothing
    first = patches[0].copy()
    stretch(first, plant.pads["axes"][0, 0])
    plant.cells = np.tile(first, (*plant.pads.shape, 1, 1))
    return patches
