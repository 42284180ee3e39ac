"""Checks both contacts of a uniform disc, a table and cells, against its exact limit surface."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from estimator.limit_surface import DISC_RADIUS, disc_friction
from slipgym.validation.bench import Figure
from slipgym.validation.breakaway import BOUND, ramp
from slipgym.validation.creep import ANGLE_BOUND, DISTANCE_BOUND, drift, sway
from slipgym.validation.energy import FALL_BOUND, drop, slide, throw
from slipgym.validation.steady import deviation, summary

DIRECTIONS = 7  # gamma_t from 1 to 0
THROWS = 3
LOADS = {
    "along x": (1.0, 0.0, 0.0),
    "oblique": (0.6, 0.8, 0.0),
    "torque": (0.0, 0.0, 1.0),
    "force and torque": (0.5, -0.4, 0.77),
    "force, little torque": (-0.9, 0.3, 0.3),
}


def exact(twist: np.ndarray) -> np.ndarray:
    """Scaled friction over mu_c f_n of a uniform disc, opposing scaled twists, both (n, 3)."""
    v_t, spin = np.hypot(twist[:, 0], twist[:, 1]), np.abs(twist[:, 2])
    tiny = np.finfo(float).tiny
    force, torque = np.array(
        [disc_friction(DISC_RADIUS * v / max(s, tiny)) for v, s in zip(v_t, spin, strict=True)]
    ).T
    heading = twist[:, :2] / np.maximum(v_t, tiny)[:, None]
    return -np.column_stack((force[:, None] * heading, np.sign(twist[:, 2]) * torque / DISC_RADIUS))


def limit(direction: tuple[float, float, float]) -> float:
    """Size of the scaled load over mu f_n at which a uniform disc slips, along a direction."""
    ratios = np.logspace(4.0, -4.0, 4001)  # from translation to spin
    force, torque = np.array([disc_friction(ratio) for ratio in ratios]).T
    scaled = torque / DISC_RADIUS
    angle = math.atan2(abs(direction[2]), math.hypot(direction[0], direction[1]))
    return float(np.interp(angle, np.arctan2(scaled, force), np.hypot(force, scaled)))


def figures(model: str) -> Iterator[Figure]:
    """Creep, break-away, steady slip, energy and free fall of a contact model."""
    distance, angle = drift(0.01, sway, contact=model)
    yield Figure(f"{model}: creep, both, wrist swaying", DISTANCE_BOUND, distance, "mm")
    yield Figure(f"{model}: creep, both, wrist swaying", ANGLE_BOUND, angle, "deg")
    # A ramp is slow enough for mu_s in every cell. At break-away the cells nearest to the centre of
    # rotation have not come to their limit; they carry little
    for name, direction in LOADS.items():
        away = ramp(direction, contact=model) / limit(direction) - 1.0
        yield Figure(f"{model}: break-away, {name}", BOUND, 100.0 * abs(away), "%")
    angles = np.linspace(0.0, 0.5 * math.pi, DIRECTIONS)
    yield summary(
        f"{model}: steady slip", "disc", [deviation(angle, 0.0, exact, contact=model) for angle in angles]
    )
    rises = [throw(seed, vary, contact=model)[0] for seed in range(THROWS) for vary in (False, True)]
    yield Figure(f"{model}: energy gained, random throws", 1.0, max(rises), "store")
    rises = [slide(seed, contact=model) for seed in range(THROWS)]
    yield Figure(f"{model}: energy gained, slipping and sticking", 1.0, max(rises), "store")
    yield Figure(f"{model}: free fall without grip", FALL_BOUND, drop(contact=model), "%")


def disc() -> Iterator[Figure]:
    """The contact whose limit surface is a table."""
    yield from figures("disc")


def distributed() -> Iterator[Figure]:
    """The contact of cells."""
    yield from figures("distributed")
