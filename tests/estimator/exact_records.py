"""Generates exact contact data, independently of the estimators.

Records are lists of samples (t, wrench, twist) at 120 Hz, one per control step.
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

import estimator
from estimator.limit_surface import disc_friction
from estimator.online import OnlineEstimator

RATE = 120.0
"""Control rate [Hz]."""
COUNT = 7.94e-6
"""Displacement of one count of the optical velocity sensor [m]."""

Sample = tuple[float, tuple[float, float, float, float], tuple[float, float, float]]


class Phase(NamedTuple):
    """A stretch of translation along x at constant speed [m/s]; f_t ramps between the two values [N]."""

    samples: int
    speed: float
    f_t: tuple[float, float]


def ellipsoid(
    n: int,
    v_t: float,
    omega: float,
    mu_c: float,
    r: float,
    f_n: float = 5.0,
    start: int = 1,
    angle: float = 0.3,
) -> list[Sample]:
    """Steady slip on the ellipsoid limit surface: the scaled wrench is mu_c f_n against the scaled twist.

    Args:
        n: Samples.
        v_t: Translation speed [m/s], in direction `angle` [rad].
        omega: Spin [rad/s].
        mu_c: True Coulomb friction [-].
        r: True rim radius [m].
        f_n: Normal force [N].
        start: Index of the first sample; time is index / RATE.
        angle: Direction of translation [rad].
    """
    scaled = np.array([v_t * np.cos(angle), v_t * np.sin(angle), r * omega])
    f_x, f_y, rim_force = -mu_c * f_n * scaled / np.linalg.norm(scaled)
    wrench = (f_x, f_y, f_n, r * rim_force)
    twist = (scaled[0], scaled[1], omega)
    return [((start + k) / RATE, wrench, twist) for k in range(n)]


def disc(
    n: int,
    v_t: float,
    omega: float,
    mu_c: float,
    r: float,
    f_n: float = 5.0,
    start: int = 1,
    angle: float = 0.3,
) -> list[Sample]:
    """Steady slip of a uniform disc of radius 3 r / 2; arguments as `ellipsoid`.

    Its friction is `disc_friction`, which a test holds to the integral over the area.
    """
    force, torque = disc_friction(v_t / (1.5 * r * abs(omega)) if omega else np.inf)
    direction = np.array([np.cos(angle), np.sin(angle)])
    f_x, f_y = -mu_c * f_n * force * direction
    wrench = (f_x, f_y, f_n, -np.sign(omega) * mu_c * f_n * 1.5 * r * torque)
    twist = (*(v_t * direction), omega)
    return [((start + k) / RATE, wrench, twist) for k in range(n)]


def planar(gamma_t: float, r: float, speed: float = 0.02) -> tuple[float, float]:
    """(v_t, omega) of a slip with a given fraction of translation at the true r and scaled speed [m/s]."""
    return gamma_t * speed, np.sqrt(1.0 - gamma_t**2) * speed / r


def counted(phases: Sequence[Phase], f_n: float = 5.0) -> tuple[list[Sample], list[int]]:
    """Translation as the optical sensor sees it: whole counts per window over the window's duration.

    Returns:
        The record, and the index of the first sample of each phase.
    """
    speeds = np.concatenate([np.full(phase.samples, phase.speed) for phase in phases])
    forces = np.concatenate([np.linspace(*phase.f_t, phase.samples) for phase in phases])
    path = np.concatenate([[0.0], np.cumsum(speeds) / RATE])
    velocities = np.diff(np.floor(path / COUNT)) * COUNT * RATE
    record = [
        ((k + 1) / RATE, (forces[k], 0.0, f_n, 0.0), (velocities[k], 0.0, 0.0)) for k in range(len(speeds))
    ]
    return record, np.cumsum([0] + [phase.samples for phase in phases])[:-1].tolist()


def run(est: OnlineEstimator, record: Iterable[Sample]) -> list[estimator.Estimate]:
    """Update an estimator with a record; return the estimates."""
    return [est.update(*sample) for sample in record]
