"""What an episode draws beyond its task's own draws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from slipgym.config import Config, Material, Randomization, Ranges, TaskConfig
from slipgym.config.disturbances import AnyDisturbance
from slipgym.config.errors import unknown
from slipgym.envs.equipment import with_pressure
from slipgym.envs.happenings import SHARES
from slipgym.tasks.options import EpisodeOptions

FRICTION = ("mu_c", "mu_s", "friction_ratio")
"""Fields that have no value of their own in the configuration."""

_FIXED_BY = {
    "mass_scale": "object_mass",
    "size_scale": "object_size",
    "com_x": "com_offset",
    "com_z": "com_offset",
    "radius_scale": "r",
}


def nominal_values(config: Config) -> dict[str, float]:
    """Numbers of `Ranges` as they are without randomization, but for `FRICTION`."""
    contact, gripper = config.contact, config.gripper
    return {
        "friction_drift": 0.0,
        "stribeck_velocity": contact.stribeck_velocity,
        "sigma_0": contact.sigma_0,
        "radius_scale": 1.0,
        "mass_scale": 1.0,
        "size_scale": 1.0,
        "com_x": 0.0,
        "com_z": 0.0,
        "lag": gripper.lag,
        "dead_time": gripper.dead_time,
        "noise_scale": 1.0,
        "bias_scale": 0.0,
        "slip_latency": config.sensors.slip.latency_samples,
    }


def blend(nominal: float, drawn: float, scale: float) -> float:
    """From what is without randomization (scale 0) to what was drawn (1)."""
    return (1.0 - scale) * nominal + scale * drawn


@dataclass(frozen=True)
class Draw:
    """Draws of one episode."""

    scale: float
    """How far they go from what is without randomization, 0 to 1."""
    values: Mapping[str, float]
    """Every number of `nominal_values`, drawn or not."""
    drawn: tuple[str, ...]
    """Names of those that were drawn."""
    friction: Mapping[str, float]
    """Those of `FRICTION` that were drawn, at scale 1."""
    material: str | None
    """Name of the material; None: as the task draws it."""
    config: Config
    """Configuration with the pressure of the episode."""
    happenings: tuple[tuple[AnyDisturbance, np.ndarray], ...]
    """Disturbances that the episode has, each with shares in [0, 1) of its distributions."""

    def friction_of(self, material: Material) -> tuple[float, float]:
        """Static and Coulomb friction where the material would have those given."""
        mu_c = self.friction.get("mu_c", material.mu_c)
        ratio = self.friction.get("friction_ratio", material.mu_s / material.mu_c)
        mu_s = self.friction.get("mu_s", ratio * mu_c)
        return blend(material.mu_s, mu_s, self.scale), blend(material.mu_c, mu_c, self.scale)

    def report(self, options: EpisodeOptions) -> dict[str, Any]:
        """What was drawn and not fixed by options, JSON-like; friction and mass come from the episode."""
        kept = [name for name in self.drawn if getattr(options, _FIXED_BY.get(name, ""), None) is None]
        happened = ", ".join(disturbance.kind for disturbance, _ in self.happenings)
        return {
            **{name: self.values[name] for name in kept},
            "pressure": self.config.contact.pressure,
            "disturbances": happened,
        }


class Randomizer:
    """Draws the episodes of a task.

    Args:
        config: The environment's configuration.
        settings: The task's settings.
        task: Its key.
        randomization: What is drawn.

    Attributes:
        active: Whether anything is drawn.
        pressures: Pressures that an episode may have.
        most: Largest value of every number.

    Raises:
        ValueError: A material is unknown, or the pads have no room for the largest contact radius.
    """

    def __init__(self, config: Config, settings: TaskConfig, task: str, randomization: Randomization) -> None:
        self._ranges = randomization.of(task)
        self._nominal = nominal_values(config)
        self.active = self._ranges != Ranges()
        fields = ((name, getattr(self._ranges, name)) for name in Ranges.model_fields)
        self._drawn = [
            (name, field) for name, field in fields if name != "disturbances" and field is not None
        ]
        self.pressures = tuple(dict.fromkeys((config.contact.pressure, *(self._ranges.pressure or ()))))
        self._configs = {pressure: with_pressure(config, pressure) for pressure in self.pressures}
        self._pressure = config.contact.pressure
        drawn = {name: getattr(self._ranges, name) for name in self._nominal}
        self.most = {
            name: max(self._nominal[name], drawn[name].ends[1]) if drawn[name] else self._nominal[name]
            for name in self._nominal
        }
        for material in self._ranges.materials or ():
            if material not in config.materials:
                raise ValueError(f"randomization: {unknown('material', material, config.materials)}")
        for variant in self._configs.values():
            r = self.most["radius_scale"] * (settings.radius or variant.contact_radius)
            if self.active:
                _check_radius(variant, r)

    def draws(self, name: str) -> bool:
        """Whether episodes differ in one of the numbers of `nominal_values`."""
        return getattr(self._ranges, name) is not None

    def draw(self, rng: np.random.Generator, scale: float) -> Draw:
        """Draw an episode; the same number of draws whatever the scale.

        Args:
            rng: Source of the draws; not touched if nothing is drawn.
            scale: 0 for the configuration, 1 for the full ranges; numbers lie in proportion between,
                names and disturbances are drawn with this probability.
        """
        values, friction, names, drawn = dict(self._nominal), {}, {}, []
        for name, field in self._drawn:
            share, gate = rng.random(2).tolist()
            if isinstance(field, tuple):
                names[name] = field[int(share * len(field))] if gate < scale else None
            elif name in FRICTION:
                friction[name] = field.at(share)
            else:
                values[name] = blend(values[name], field.at(share), scale)
                drawn.append(name)
        values["slip_latency"] = round(values["slip_latency"])
        happenings = []
        for disturbance in self._ranges.disturbances:
            gate, *shares = rng.random(1 + SHARES).tolist()
            if gate < scale * disturbance.probability:
                happenings.append((disturbance, np.array(shares)))
        config = self._configs[names.get("pressure") or self._pressure]
        return Draw(scale, values, tuple(drawn), friction, names.get("materials"), config, tuple(happenings))


def _check_radius(config: Config, r: float) -> None:
    pad = config.gripper.pad_radius
    if r > pad * (1.0 + 1e-9):
        raise ValueError(
            f"randomization: the largest radius r = {r:g} m must not exceed gripper.pad_radius = {pad:g} m"
        )
    config.check_patch("randomization: the largest radius r", r)
