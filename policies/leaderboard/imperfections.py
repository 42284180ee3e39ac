"""Imperfections of a real gripper's sensors, added to sensor records afterwards.

A record of `slipgym.synthetic.sense` with the latency 0 is exact in time, centre of pressure and zero. An
`Imperfections` says by how much a sensor is off, `impaired` draws directions and instants for each finger:

    late = impaired(record, Imperfections(velocity_delay=2, jitter=0.3), seed=1)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from slipgym.config import load
from slipgym.config.errors import unknown
from slipgym.synthetic import Record


@dataclass(frozen=True)
class Imperfections:
    """Sizes of the errors; the defaults are none."""

    velocity_delay: int = 0
    """Age of the velocities [samples]."""
    jitter: float = 0.0
    """Fraction of the velocities that come one sample later still [-]."""
    drop_outs: float = 0.0
    """Fraction of the velocities that are lost: the one before is repeated [-]."""
    velocity_scale: float = 0.0
    """Relative error of the velocities; either sign [-]."""
    force_delay: float = 0.0
    """Age of the wrenches [s]."""
    zero: float = 0.0
    """Zero error of the tangential force, in any direction [N]."""
    zero_normal: float = 0.0
    """Zero error of the normal force; either sign [N]."""
    tilt: float = 0.0
    """Tilt of the force sensor's frame, about any axis in the contact plane [rad]."""
    cross_talk: float = 0.0
    """Fraction of each force that appears in the others; either sign [-]."""
    cop: float = 0.0
    """Error of the centre of pressure, in any direction [m]."""


def impaired(record: Record, imperfections: Imperfections, seed: int = 0) -> Record:
    """A record of m fingers as a gripper with these imperfections would have taken it.

    Directions are spread evenly over the fingers from a random start, signs and instants are random. The
    first velocities of a delayed sensor are zero. A force between two samples is interpolated.
    """
    rng = np.random.default_rng(seed)
    m = len(record.wrenches)
    wrenches = _impaired_forces(record, imperfections, rng)
    twists = _impaired_velocities(record.twists, imperfections, rng)
    e_x, e_y = imperfections.cop * _directions(m, rng)
    omega = twists[..., 2]
    twists[..., 0] -= omega * e_y[:, None]
    twists[..., 1] += omega * e_x[:, None]
    wrenches[..., 3] -= e_x[:, None] * wrenches[..., 1] - e_y[:, None] * wrenches[..., 0]
    return replace(record, wrenches=wrenches, twists=twists)


def _directions(m: int, rng: np.random.Generator) -> np.ndarray:
    """Unit vectors (2, m), evenly spread from a random start and in random order."""
    angles = rng.permutation(2.0 * np.pi * (np.arange(m) + rng.random()) / m)
    return np.array([np.cos(angles), np.sin(angles)])


def _impaired_forces(record: Record, imperfections: Imperfections, rng: np.random.Generator) -> np.ndarray:
    """Wrenches (m, n, 4) of a late, tilted and biased force sensor."""
    m = len(record.wrenches)
    past = record.t - imperfections.force_delay
    signals = record.wrenches.swapaxes(1, 2).reshape(4 * m, -1)
    late = np.array([np.interp(past, record.t, signal) for signal in signals])
    wrenches = late.reshape(m, 4, -1).swapaxes(1, 2).copy()
    tilts = imperfections.tilt * np.vstack((_directions(m, rng), np.zeros(m)))
    zero_x, zero_y = imperfections.zero * _directions(m, rng)
    zero_n = imperfections.zero_normal * rng.choice((-1.0, 1.0), m)
    cross_talk = imperfections.cross_talk * rng.choice((-1.0, 1.0), (m, 3, 3)) * (1.0 - np.eye(3))
    matrices = (np.eye(3) + cross_talk) @ Rotation.from_rotvec(tilts.T).as_matrix()
    zeros = np.column_stack((zero_x, zero_y, zero_n))[:, None]
    wrenches[..., :3] = wrenches[..., :3] @ matrices.swapaxes(1, 2) + zeros
    return wrenches


def _impaired_velocities(
    twists: np.ndarray, imperfections: Imperfections, rng: np.random.Generator
) -> np.ndarray:
    """Twists (m, n, 3) of a late sensor whose samples jitter, drop out and are scaled."""
    m, n, _ = twists.shape
    arrived = np.arange(n) - imperfections.velocity_delay - (rng.random((m, n)) < imperfections.jitter)
    lost = rng.random((m, n)) < imperfections.drop_outs
    scale = 1.0 + imperfections.velocity_scale * rng.choice((-1.0, 1.0), m)
    delayed = np.take_along_axis(twists, np.maximum(arrived, 0)[..., None], axis=1)
    delayed[arrived < 0] = 0.0
    last = np.maximum.accumulate(np.where(lost, 0, np.arange(n)), axis=1)
    return scale[:, None, None] * np.take_along_axis(delayed, last[..., None], axis=1)


Values = dict[str, dict[str, Any]]
IMPERFECTIONS = {
    "bias": {"force_torque": ("bias_tangential", "bias_normal", "bias_torque")},
    "drift": {"force_torque": ("drift_tangential", "drift_normal", "drift_torque")},
    "tilt": {"force_torque": ("tilt",)},
    "cross-talk": {"force_torque": ("crosstalk",)},
    "off centre": {"force_torque": ("off_centre",)},
    "fingertip": {"force_torque": ("tip_mass", "tip_mass_spread")},
    "late force": {"force_torque": ("latency_spread", "own_latency")},
    "vibration": {"force_torque": ("mode_frequency", "mode_damping")},
    "late velocity": {"slip": ("latency_samples", "latency_spread", "own_latency", "jitter")},
    "resting chips": {"slip": ("rest_after", "rest_period", "speed_max")},
    "scale": {"slip": ("scale_error",)},
    "lost chip": {"slip": ("chip_failure",)},
    "lost readings": {"force_torque": ("dropout",), "slip": ("dropout",)},
}
"""Label -> for each sensor the parameters in which "lab" differs from "realistic"."""


def values_of(label: str, preset: str = "lab") -> Values:
    """Values of a preset of the sensors for one of `IMPERFECTIONS`: sensor -> parameter -> value.

    Raises:
        ValueError: There is no such imperfection.
    """
    if label not in IMPERFECTIONS:
        raise ValueError(unknown("imperfection", label, IMPERFECTIONS))
    sensors = load(sensors=preset).sensors
    return {
        sensor: {name: getattr(getattr(sensors, sensor), name) for name in names}
        for sensor, names in IMPERFECTIONS[label].items()
    }


def without(labels: Sequence[str]) -> Mapping[str, Any]:
    """Overrides of the configuration that give sensors what "realistic" has instead of some imperfections.

    They are named as in `IMPERFECTIONS`; hyphens may stand for spaces.

    Raises:
        ValueError: There is no such imperfection.
    """
    found: Values = {}
    spaced = {label.replace(" ", "-"): label for label in IMPERFECTIONS}
    for label in labels:
        for sensor, values in values_of(spaced.get(label, label), "realistic").items():
            found[sensor] = {**found.get(sensor, {}), **values}
    return {"sensors": found} if found else {}
