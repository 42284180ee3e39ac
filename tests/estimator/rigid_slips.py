"""Generates slips on the ellipsoid limit surface and what a finger's sensors see of them.

A motion is a list of phases: rests and slips under a steady normal force. Nothing is viscous and the pad is
rigid, or a spring in shear, so that the truth is mu_c, mu_s and r alone.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

import estimator

FINE = 6000
"""Steps of the truth in a second, a multiple of all rates [Hz]."""
STRIBECK = 1e-3  # [m/s]
LOADED = 0.1
"""Time before a slip in which the load rises to static friction [s]."""
NOISE = np.array([0.02, 0.02, 0.04, 5e-4])
"""Of f_x, f_y, f_n, tau [N, N, N, N m]."""
COUNT, CHIPS = 7.94e-6, 0.0243
"""Of the optical sensors: a count, and their distance from the centre [m]."""
ANGLES = np.radians([90.0, 210.0, 330.0])


class Pad(NamedTuple):
    """Friction of the pad, mu_s of 0 is mu_c, and its compliance in shear [m/N]."""

    mu_c: float
    r: float
    mu_s: float = 0.0
    compliance: float = 0.0


class Phase(NamedTuple):
    """A time [s] under a normal force [N] with a slip twist, zero at rest, whose direction turns [rad/s]."""

    time: float
    f_n: float
    twist: Sequence[float] = (0.0, 0.0, 0.0)
    turn: float = 0.0
    factor: float = 1.0
    """Of both coefficients of friction."""


class Motion(NamedTuple):
    """At `FINE`: f_x, f_y, f_n, tau of the load on the finger (n, 4), the twist of the object (n, 3)."""

    wrench: np.ndarray
    twist: np.ndarray


class Sensors(NamedTuple):
    """Of one finger."""

    late: int = 1
    """Samples by which the velocity is late."""
    noise: float = 1.0
    """White noise over that of the presets; with 0 the velocities have no counts either."""
    count: float = COUNT
    zero: Sequence[float] = (0.0, 0.0, 0.0, 0.0)
    tilt: Sequence[float] = (0.0, 0.0)
    cop: Sequence[float] = (0.0, 0.0)
    """True less assumed centre of pressure [m]."""
    gain: float = 1.0
    """Measured over true normal force."""
    sign: int = 1
    """1: the load on the finger; -1: the friction on the object."""


def planar(pad: Pad, gamma_t: float, angle: float, speed: float = 0.02, turn: int = 1) -> tuple[float, ...]:
    """A slip twist by its fraction of translation, the direction of this [rad] and the scaled speed [m/s]."""
    spin = turn * np.sqrt(1.0 - gamma_t**2) / pad.r
    return tuple(speed * np.array([gamma_t * np.cos(angle), gamma_t * np.sin(angle), spin]))


def contact(phases: Sequence[Phase], pad: Pad, held: float = 0.0, rise: float = 0.02) -> Motion:
    """What happens: at rest the load is a fraction `held` of that of the slip before, then of the next one.

    A slip takes `rise` [s] to its speed and from it. With mu_s above mu_c the load rises to it before a slip.
    """
    scale = np.array([1.0, 1.0, pad.r])
    mu_s = max(pad.mu_s, pad.mu_c)
    wrenches, twists, now = [], [], np.zeros(3)
    for i, phase in enumerate(phases):
        n = round(phase.time * FINE)
        s = (np.arange(n) + 0.5) / FINE
        if np.any(phase.twist):
            speed = np.clip(np.minimum(s, phase.time - s) / max(rise, 1e-9), 0.0, 1.0)
            twist = speed[:, None] * turned(phase.twist, phase.turn * s)
            unit = turned(phase.twist, phase.turn * s) * scale
            size = np.linalg.norm(unit, axis=1, keepdims=True)
            mu = pad.mu_c + (mu_s - pad.mu_c) * np.exp(-((speed[:, None] * size / STRIBECK) ** 2))
            load, now = mu * unit / size, unit[-1] / size[-1]
        else:
            coming = next(
                (np.multiply(other.twist, scale) for other in phases[i:] if np.any(other.twist)), None
            )
            after = np.zeros(3) if coming is None else coming / np.linalg.norm(coming)
            load = held * pad.mu_c * np.where(s[:, None] < 0.5 * phase.time, now, after)
            twist = np.zeros((n, 3))
            if mu_s > pad.mu_c:
                share = np.clip((s[:, None] - phase.time) / LOADED + 1.0, 0.0, 1.0)
                load = (1.0 - share) * load + share * mu_s * after
        f_x, f_y, torque = (phase.factor * phase.f_n * load * scale).T
        wrenches.append(np.column_stack((f_x, f_y, np.full(n, phase.f_n), torque)))
        twists.append(twist)
    return sprung(np.concatenate(wrenches), np.concatenate(twists), pad)


def sprung(wrench: np.ndarray, slip: np.ndarray, pad: Pad) -> Motion:
    """A motion whose slip (n, 3) is known: the spring of the pad gives way with the load (n, 4)."""
    twist = slip.copy()
    twist[1:, :2] += pad.compliance * FINE * np.diff(wrench[:, :2], axis=0)
    return Motion(wrench, twist)


def turned(twist: Sequence[float], angle: np.ndarray) -> np.ndarray:
    """A twist with its translation turned by angles (n,): (n, 3)."""
    (x, y, omega), c, s = twist, np.cos(angle), np.sin(angle)
    return np.column_stack((c * x - s * y, s * x + c * y, np.full(len(angle), omega)))


def steps(motion: Motion, rate: int = 120, irregular: bool = False, seed: int = 0) -> np.ndarray:
    """Numbers of the steps at whose ends samples are taken, (m,); irregular: each off by up to a third."""
    each = FINE // rate
    ends = np.arange(each, len(motion.twist) + 1, each)
    if irregular:
        off = np.random.default_rng(seed).integers(-each // 3, each // 3 + 1, len(ends))
        ends = np.minimum(ends + off, len(motion.twist))
    return np.unique(ends)


def sense(motion: Motion, at: np.ndarray, sensors: Sensors, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Wrenches (m, 4) and twists (m, 3) that the sensors give at the ends of the steps (m,)."""
    rng, (c_x, c_y) = np.random.default_rng(seed), sensors.cop
    f_x, f_y, f_n, torque = motion.wrench[at - 1].T
    wrench = np.column_stack((f_x, f_y, f_n * sensors.gain, torque + c_x * f_y - c_y * f_x))
    wrench[:, [0, 1, 3]] *= sensors.sign
    wrench[:, :2] += np.outer(f_n, sensors.tilt)
    wrench += np.array(sensors.zero) + sensors.noise * NOISE * rng.standard_normal(wrench.shape)
    way = np.concatenate([np.zeros((1, 3)), np.cumsum(motion.twist, axis=0) / FINE])[np.append(0, at)]
    x, y, theta = way[:, 0] + way[:, 2] * c_y, way[:, 1] - way[:, 2] * c_x, way[:, 2]
    if sensors.noise > 0.0:
        axes = [row for a in ANGLES for row in ((1, 0, -CHIPS * np.sin(a)), (0, 1, CHIPS * np.cos(a)))]
        ways = np.column_stack((x, y, theta)) @ np.array(axes).T / sensors.count
        counted = np.floor(ways + rng.uniform(size=6)) * sensors.count
        x, y, theta = np.linalg.lstsq(np.array(axes), counted.T, rcond=None)[0]
    twist = np.diff(np.column_stack((x, y, theta)), axis=0) * FINE / np.diff(at, prepend=0)[:, None]
    return wrench, np.concatenate([np.zeros((sensors.late, 3)), twist])[: len(at)]


def replay(name: str, at: np.ndarray, records: Sequence[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """ESTIMATE (m, k) of an estimator on k records with samples at the same m steps."""
    wrenches, twists = (np.ascontiguousarray(np.stack(part, axis=1)) for part in zip(*records, strict=True))
    batch = estimator.make_batch(name, len(records))
    found = np.empty((len(at), len(records)), batch.estimates.dtype)
    for k, t in enumerate((at / FINE).tolist()):
        batch.update(t, wrenches[k], twists[k])
        found[k] = batch.estimates
    return found


def followed(
    name: str, phases: Sequence[Phase], pad: Pad, *cases: Sensors, **contact_options: float
) -> np.ndarray:
    """ESTIMATE (m, k) at 120 Hz of the same motion with k kinds of sensors."""
    motion = contact(phases, pad, **contact_options)
    at = steps(motion)
    return replay(name, at, [sense(motion, at, case, seed) for seed, case in enumerate(cases)])
