"""Samples the randomized values of an episode and schedules its disturbances."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from slipgym.config import Config, Material, Randomization, Ranges, TaskConfig
from slipgym.config.disturbances import AnyDisturbance, FrictionJump, MassChange, Push, Shake, SurfaceRegion
from slipgym.config.errors import NEEDS_TILT, unknown
from slipgym.config.pad import EFFECTS
from slipgym.envs.finger_differences import (
    DIFFERENCES,
    Numbers,
    named,
    nominal_differences,
    sample_difference,
)
from slipgym.envs.hardware_randomization import with_pressure
from slipgym.tasks.options import EpisodeOptions

UNIFORMS = 8
"""Number of uniform random numbers per disturbance, the most that any kind needs."""
FRICTION = ("mu_c", "mu_s", "friction_ratio")
"""Fields that have no value of their own in the configuration."""

_FIXED_BY = {
    "mass_scale": "object_mass",
    "size_scale": "object_size",
    "com_x": "com_offset",
    "com_z": "com_offset",
    "radius_scale": "r",
    **{name: name for name in DIFFERENCES},
}


def nominal_values(config: Config) -> dict[str, float]:
    """Values of the numeric fields of `Ranges` without randomization, except `FRICTION` and `DIFFERENCES`."""
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
        **{name: getattr(contact.pad, name) for name in EFFECTS},
    }


def blend(nominal: float, drawn: float, scale: float) -> float:
    """Interpolate between the value without randomization (scale 0) and the sampled one (scale 1)."""
    return (1.0 - scale) * nominal + scale * drawn


@dataclass(frozen=True)
class Draw:
    """Sampled values of one episode."""

    scale: float
    """Fraction of the randomization's ranges, 0 (no randomization) to 1."""
    values: Mapping[str, float]
    """Every number of `nominal_values`, sampled or not."""
    differences: Mapping[str, Numbers]
    """Every number of `DIFFERENCES`, sampled or not."""
    drawn: tuple[str, ...]
    """Names of the values that were sampled."""
    friction: Mapping[str, float]
    """Sampled values of `FRICTION`, at scale 1."""
    material: str | None
    """Name of the material; None: the task samples it."""
    config: Config
    """Configuration with the pressure profile of the episode."""
    disturbances: tuple[tuple[AnyDisturbance, np.ndarray], ...]
    """Disturbances of the episode, each with uniform random numbers in [0, 1) for its distributions."""

    def friction_of(self, material: Material) -> tuple[float, float]:
        """Randomized static and Coulomb friction, from those of the material."""
        mu_c = self.friction.get("mu_c", material.mu_c)
        ratio = self.friction.get("friction_ratio", material.mu_s / material.mu_c)
        mu_s = self.friction.get("mu_s", ratio * mu_c)
        return blend(material.mu_s, mu_s, self.scale), blend(material.mu_c, mu_c, self.scale)

    def report(self, options: EpisodeOptions) -> dict[str, Any]:
        """Sampled values that options do not fix, JSON-like; friction and mass come from the episode."""
        kept = [name for name in self.drawn if getattr(options, _FIXED_BY.get(name, ""), None) is None]
        numbers = {}
        for name in kept:
            own = self.differences.get(name)
            numbers |= {name: self.values[name]} if own is None else named(name, own)
        happened = ", ".join(disturbance.kind for disturbance, _ in self.disturbances)
        return {
            **numbers,
            "pressure": self.config.contact.pressure,
            "disturbances": happened,
        }


class Randomizer:
    """Samples the randomized values of a task's episodes.

    Args:
        config: The environment's configuration.
        settings: The task's settings.
        task: The task's key.
        randomization: Distributions that an episode is sampled from.

    Attributes:
        active: Whether anything is sampled.
        soft: Whether pads may be soft or uneven.
        pressures: Pressure profiles that an episode may have.
        most: Largest possible value of every number.

    Raises:
        ValueError: A material is unknown, the largest contact radius does not fit on the pads, or the wrist
            shakes out of the contact plane without `physics.tilt`.
    """

    def __init__(self, config: Config, settings: TaskConfig, task: str, randomization: Randomization) -> None:
        self._ranges = randomization.of(task)
        for disturbance in () if config.physics.tilt else self._ranges.disturbances:
            if isinstance(disturbance, Shake) and (disturbance.roll or disturbance.sway):
                raise ValueError(f"randomization: shake in roll or sway {NEEDS_TILT}")
        self._nominal, self._alike = nominal_values(config), nominal_differences(config)
        self.active = self._ranges != Ranges()
        self.soft = any(self.draws(name) for name in EFFECTS)
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
        if self._ranges.cop_offset is not None:
            least, most = self._ranges.cop_offset.ends
            farthest = max(abs(least), abs(most))
            config.check_cop_offset("randomization.cop_offset: the farthest", [(farthest, farthest)])
        for variant in self._configs.values():
            r = self.most["radius_scale"] * (settings.radius or variant.contact_radius)
            r *= self._largest("finger_radius")
            if self.active:
                _check_radius(variant, r)

    def _largest(self, name: str) -> float:
        field, nominal = getattr(self._ranges, name), self._alike[name]
        return max(*nominal, field.ends[1]) if field else max(nominal)

    def draws(self, name: str) -> bool:
        """Whether a number of `nominal_values` is randomized."""
        return getattr(self._ranges, name) is not None

    def draw(self, rng: np.random.Generator, scale: float) -> Draw:
        """Sample an episode; the number of random draws does not depend on the scale.

        Args:
            rng: Random generator; unused if nothing is sampled.
            scale: 0 for the configuration, 1 for the full ranges. Numbers are interpolated; names and
                disturbances are sampled with this probability.
        """
        values, differences = dict(self._nominal), self._alike
        friction, names, drawn = {}, {}, []
        for name, field in self._drawn:
            if name in DIFFERENCES:
                numbers = sample_difference(field, self._alike[name], scale, rng)
                differences = {**differences, name: numbers}
                drawn.append(name)
                continue
            u, gate = rng.random(2).tolist()
            if isinstance(field, tuple):
                names[name] = field[int(u * len(field))] if gate < scale else None
            elif name in FRICTION:
                friction[name] = field.at(u)
            else:
                values[name] = blend(values[name], field.at(u), scale)
                drawn.append(name)
        values["slip_latency"] = round(values["slip_latency"])
        disturbances = []
        for disturbance in self._ranges.disturbances:
            gate, *u = rng.random(1 + UNIFORMS).tolist()
            if gate < scale * disturbance.probability:
                disturbances.append((disturbance, np.array(u)))
        config = self._configs[names.get("pressure") or self._pressure]
        return Draw(
            scale=scale,
            values=values,
            differences=differences,
            drawn=tuple(drawn),
            friction=friction,
            material=names.get("materials"),
            config=config,
            disturbances=tuple(disturbances),
        )


def _check_radius(config: Config, r: float) -> None:
    pad = config.gripper.pad_radius
    if r > pad * (1.0 + 1e-9):
        raise ValueError(
            f"randomization: the largest radius r = {r:g} m must not exceed gripper.pad_radius = {pad:g} m"
        )
    config.check_patch("randomization: the largest radius r", r)


def schedule_disturbance(disturbance: AnyDisturbance, u: np.ndarray, episode: np.void) -> None:
    """Write a disturbance into an episode.

    Args:
        disturbance: Its distributions.
        u: Uniform random numbers in [0, 1), (UNIFORMS,).
        episode: EPISODE record; its step_time, mass and friction must be set.
    """
    _SCHEDULE[disturbance.kind](disturbance, u.tolist(), episode)


def _step(episode: np.void, time: float) -> int:
    return round(time / float(episode["step_time"]))


def _push(push: Push, u: list[float], episode: np.void) -> None:
    begin = _step(episode, push.time.at(u[0]))
    steps = max(1, _step(episode, push.duration.at(u[1])))
    force = push.impulse.at(u[2]) / (steps * float(episode["step_time"]))
    heading, lever = push.direction.at(u[3]), push.lever.at(u[4])
    k = int(episode["pushes"])
    episode["push_start"][k], episode["push_end"][k] = begin, begin + steps
    episode["push_wrench"][k] = force * math.cos(heading), force * math.sin(heading), force * lever
    episode["pushes"] = k + 1


def _shake(shake: Shake, u: list[float], episode: np.void) -> None:
    along, pitch = shake.amplitude.at(u[0]), shake.pitch.at(u[1])
    omega = [math.tau * shake.frequency.at(each) for each in u[2:5]]
    phase = [math.tau * each for each in u[5:8]]
    episode["shakes"][1] = np.column_stack(([along, along, pitch], omega, phase))
    if shake.roll is not None or shake.sway is not None:
        more = np.random.default_rng(int(u[7] * 2.0**53)).random(6).tolist()  # beyond `UNIFORMS`, which stays
        sizes = [0.0 if each is None else each.at(more[k]) for k, each in enumerate((shake.roll, shake.sway))]
        omega = [math.tau * shake.frequency.at(each) for each in more[2:4]]
        episode["tilt_shakes"] = np.column_stack((sizes, omega, [math.tau * each for each in more[4:6]]))


def _mass_change(change: MassChange, u: list[float], episode: np.void) -> None:
    episode["mass_step"] = _step(episode, change.time.at(u[0]))
    episode["mass_factor"] = change.factor.at(u[1])


def _friction_jump(jump: FrictionJump, u: list[float], episode: np.void) -> None:
    episode["jump_step"] = _step(episode, jump.time.at(u[0]))
    episode["jump_factor"] = jump.factor.at(u[1])


def _surface_region(region: SurfaceRegion, u: list[float], episode: np.void) -> None:
    start = region.start.at(u[0])
    episode["region"] = start, start + region.length.at(u[1])
    episode["region_factor"] = region.factor.at(u[2])


_SCHEDULE: dict[str, Any] = {
    "push": _push,
    "shake": _shake,
    "mass_change": _mass_change,
    "friction_jump": _friction_jump,
    "surface_region": _surface_region,
}
