"""Applies the sampled parameters of pads, force loop and sensors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from slipgym.config import Config
from slipgym.config.pad import EFFECTS
from slipgym.contact.records import CELL_FIELDS
from slipgym.world.plant import (
    Plant,
    check_slip_latency,
    dead_ticks,
    pad_parameters,
    patch_of,
    stretched,
    without_cells,
)


def with_pressure(config: Config, pressure: str) -> Config:
    """The configuration with another pressure profile of the patch."""
    return config.model_copy(update={"contact": config.contact.model_copy(update={"pressure": pressure})})


class HardwareRandomization:
    """Sets the parameters of gripper and sensors for every episode.

    Args:
        config: Configuration of the plant.
        plant: The plant as it was built; its patches are enlarged to the size of the largest one.
        pressures: Pressure profiles that an episode may have.
        soft: Whether pads may be soft or uneven.

    Attributes:
        biases: Standard deviation of the force/torque sensors' biases, and their noise, which the sampled
            bias scale multiplies, (6,) each [N, N m].
    """

    def __init__(self, config: Config, plant: Plant, pressures: Sequence[str], soft: bool) -> None:
        self._config, self._plant = config, plant
        self._force_noise = plant.force_torque["noise"][0, 0].copy()
        self._slip_noise = plant.slip_sensors["noise"][0, 0].copy()
        sensor = config.sensors.force_torque
        tangential, normal, torque = sensor.bias_tangential, sensor.bias_normal, sensor.bias_torque
        spread = np.array([tangential, tangential, normal, torque, torque, torque], dtype=float)
        self.biases = spread, self._force_noise
        self._cells: dict[str, np.ndarray] = {}
        if soft and plant.cells is None:
            plant.cells = without_cells(len(plant.pads))
        if config.contact.model == "distributed":
            patches = {pressure: patch_of(with_pressure(config, pressure)) for pressure in pressures}
            size = max(cells.shape[1] for cells in patches.values())
            for pressure, cells in patches.items():
                self._cells[pressure] = np.zeros((CELL_FIELDS, size))  # a cell of weight 0 does nothing
                self._cells[pressure][:, : cells.shape[1]] = cells
            cells = np.tile(self._cells[config.contact.pressure], (*plant.pads.shape, 1, 1))
            plant.cells = stretched(cells, plant.pads["axes"])

    def check(self, most: Mapping[str, float]) -> None:
        """Raise ValueError unless the plant's buffers hold the longest delays that may be sampled."""
        dead_ticks(self._config, most["dead_time"], "randomization.dead_time")
        check_slip_latency(self._config, round(most["slip_latency"]), "randomization.slip_latency")

    def apply_differences(self, i: int, differences: Mapping[str, Sequence[float]], lag: float) -> None:
        """Set what differs between the fingers of a world, except their friction and radius.

        Args:
            i: Index of the world.
            differences: See `slipgym.envs.finger_differences`.
            lag: Time constant of the force loop that each finger's factor applies to [s].
        """
        fingers, cop = self._plant.fingers, self._plant.pads["cop"]
        first, second = differences["finger_lag"]
        fingers["lag"][i] = first * lag, second * lag
        fingers["gain"][i] = differences["force_gain"]
        cop[i].flat = differences["cop_offset"]

    def apply(self, i: int, values: Mapping[str, float], pressure: str) -> None:
        """Set the parameters of a world's episode.

        Args:
            i: Index of the world.
            values: Fields of `slipgym.config.Ranges`, each of those used in this method.
            pressure: Pressure profile of the patch.
        """
        plant = self._plant
        for field in ("stribeck_velocity", "sigma_0"):
            plant.pads[field][i] = values[field]
        for name, value in pad_parameters({name: values[name] for name in EFFECTS}).items():
            plant.pads[name][i] = value
        if self._cells and plant.cells is not None:
            plant.cells[i] = stretched(np.stack([self._cells[pressure]] * 2), plant.pads["axes"][i])
        plant.fingers["dead_ticks"][i] = dead_ticks(self._config, values["dead_time"])
        plant.force_torque["noise"][i] = values["noise_scale"] * self._force_noise
        plant.slip_sensors["noise"][i] = values["noise_scale"] * self._slip_noise
        plant.slip_sensors["delay"][i] = values["slip_latency"]
