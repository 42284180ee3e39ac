"""The references: mu_c of a log by a fit that knows the exact support, and r of geometry.

The mean friction of a quasi-static push does the work mu_c times the weight times the mean path of the load,
whatever the directions of its parts. The reference mu_c is the ratio of both, summed over the pushes. Least
squares of the wrenches are a second fit, which also gives a radius: every error of a direction makes its mu_c
smaller (by the cosine, on average), and the work hardly (the principle of maximum dissipation makes the error
of second order).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lab.pushes.extract import Pushes
from lab.pushes.support import WEIGHT, mean_path, surface

SCALES = 1.01 ** np.arange(-70, 93)
"""Factors of all lengths of the support among which least squares choose, 0.5 to 2.5."""
EXACT = 70
"""Place of 1 among them."""


@dataclass(frozen=True)
class Fit:
    """What a fit finds in k resamples of the pushes of a log."""

    mu_c: np.ndarray
    """By the friction work, (k,) [-]."""
    mu_c_wrench: np.ndarray
    """By least squares of the wrenches, torques over r, (k,) [-]."""
    scale: np.ndarray
    """Factor of all lengths of the support that fits best, with a mu_c of its own, (k,) [-]."""


def expected(pushes: Pushes, scale: float = 1.0) -> np.ndarray:
    """Wrenches that move the block as it moved, at mu_c = 1.

    Args:
        pushes: Of one log.
        scale: Factor of all lengths of the support.

    Returns:
        (f_x, f_y, tau) of the pusher on the block, (n, 3) [N, N, N m].
    """
    stretch = np.array([1.0, 1.0, scale])
    return -WEIGHT * stretch * surface(pushes.support).exact(stretch * pushes.displacement)


def friction_of_each(pushes: Pushes) -> np.ndarray:
    """mu_c of each push by its friction work, (n,) [-]."""
    work = (pushes.wrench * pushes.displacement).sum(axis=1)
    return work / (WEIGHT * mean_path(pushes.support, pushes.displacement))


def fit(pushes: Pushes, chosen: np.ndarray) -> Fit:
    """Fits a log and resamples of it.

    Args:
        pushes: Of one log.
        chosen: Numbers of the pushes in each resample, (k, n).
    """
    path = mean_path(pushes.support, pushes.displacement)
    work = friction_of_each(pushes) * path
    r = surface(pushes.support).effective_radius
    per_r = np.array([1.0, 1.0, 1.0 / r])
    measured = pushes.wrench * per_r
    laws = [expected(pushes, scale) * per_r for scale in SCALES]
    products = np.array([(measured * law).sum(axis=1) for law in laws])[:, chosen].sum(axis=2)
    squares = np.array([np.square(law).sum(axis=1) for law in laws])[:, chosen].sum(axis=2)
    return Fit(
        mu_c=work[chosen].sum(axis=1) / path[chosen].sum(axis=1),
        mu_c_wrench=products[EXACT] / squares[EXACT],
        scale=SCALES[np.argmax(products**2 / squares, axis=0)],
    )


@dataclass(frozen=True)
class Misfit:
    """What the exact support does not explain of each push, (n,) each."""

    residual: np.ndarray
    """Norm of the difference of the wrenches, torques over r, over the norm of the measured one [-]."""
    direction: np.ndarray
    """Angle between measured and expected force [rad]."""
    spread: np.ndarray
    """mu_c of the push over that of the fit [-]."""
    heading: np.ndarray
    """Direction of travel in the room [rad]."""


def misfit(pushes: Pushes, mu_c: float) -> Misfit:
    """Compares every push of a log with the exact support.

    Args:
        pushes: Of one log.
        mu_c: Of the fit.
    """
    per_r = np.array([1.0, 1.0, 1.0 / surface(pushes.support).effective_radius])
    law = expected(pushes)
    difference = np.linalg.norm((pushes.wrench - mu_c * law) * per_r, axis=1)
    x, y, d_x, d_y = *law.T[:2], *pushes.displacement.T[:2]
    f_x, f_y, _ = pushes.wrench.T
    return Misfit(
        residual=difference / np.linalg.norm(pushes.wrench * per_r, axis=1),
        direction=np.abs(np.arctan2(f_x * y - f_y * x, f_x * x + f_y * y)),
        spread=friction_of_each(pushes) / mu_c,
        heading=pushes.yaw + np.arctan2(d_y, d_x),
    )


def harmonic(spread: np.ndarray, heading: np.ndarray, order: int) -> float:
    """Amplitude of a dependence of friction on the direction of travel, by least squares [-].

    Args:
        spread: As of `Misfit`, (n,).
        heading: The same.
        order: 1 for a tilted table, 2 for anisotropic friction.
    """
    columns = [np.ones(len(heading)), np.cos(order * heading), np.sin(order * heading)]
    _, a, b = np.linalg.lstsq(np.column_stack(columns), spread, rcond=None)[0]
    return float(np.hypot(a, b))
