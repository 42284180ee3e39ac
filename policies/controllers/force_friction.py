"""Friction by forces alone: from the load at a break-away, in the slide after it, and in a turn.

The limit surface of a pad lies between that of a uniform disc and the ellipsoid of Waltersson &
Karayiannidis (arXiv 2507.06824, eqs. 1-2), and both are close to

    (f_t / f_n)^p + (tau / (r f_n))^p = mu^p,    p = 1.7 for the disc, 2 for the ellipsoid.

A slide and a turn give two such equations, linear in mu_c^p and r^-p; with r a break-away gives mu_s. The
velocity is not needed, so its delay does no harm.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

DISC, ELLIPSOID = 1.7, 2.0
"""Exponents p of the limit surfaces; the disc's to 1 %."""
SMALLEST, LARGEST = 0.002, 0.015
"""Range of r [m]."""


class Ratios(NamedTuple):
    """Weighted sums of what one kind of event has shown, (n,) each; all 0 at the start."""

    weight: np.ndarray
    """Sum of 1 / variance of the logarithm of the load over the normal force [-]."""
    disc_force: np.ndarray
    """Weighted sum of (f_t / f_n)^p with the exponent of the disc [-]."""
    disc_torque: np.ndarray
    """Weighted sum of (tau / f_n)^p."""
    force: np.ndarray
    """With the exponent of the ellipsoid."""
    torque: np.ndarray

    def add(
        self, shown: np.ndarray, variance: np.ndarray, force: np.ndarray, torque: np.ndarray, r: np.ndarray
    ) -> Ratios:
        """The sums after another sample, in the rows where something is `shown`.

        The less its torque, the less its load depends on the limit surface, and the more it counts.

        Args:
            shown: Whether, (n,).
            variance: Of the logarithm of the ratio, (n,) [-].
            force: f_t / f_n, (n,) [-].
            torque: tau / f_n, (n,) [m].
            r: Contact radius so far, (n,) [m].
        """
        share = np.abs(torque) / (r * np.maximum(force, 1e-6))
        disc, ellipsoid = (np.log1p(share**p) / p for p in (DISC, ELLIPSOID))
        weight = np.where(shown, 1.0 / (variance + (disc - ellipsoid) ** 2 / 12.0), 0.0)
        powers = [part**p for p in (DISC, ELLIPSOID) for part in (np.abs(force), np.abs(torque))]
        added = [old + weight * power for old, power in zip(self[1:], powers, strict=True)]
        return Ratios(self.weight + weight, *added)

    def means(self, ellipsoid: bool) -> tuple[np.ndarray, np.ndarray]:
        """Means of (f_t / f_n)^p and (tau / f_n)^p, (n,) each; close to 0 without a sample."""
        weight = np.maximum(self.weight, 1e-12)
        force, torque = self[3:] if ellipsoid else self[1:3]
        return np.maximum(force / weight, 1e-12), np.maximum(torque / weight, 1e-12)


class Found(NamedTuple):
    """Friction by forces, (3, n) each: mu_s, mu_c [-], r [m]."""

    values: np.ndarray
    """1 where nothing is known."""
    deviations: np.ndarray
    """Relative standard deviations [-]; infinity where nothing is known."""


def solve(static: Ratios, slide: Ratios, turn: Ratios, r: np.ndarray, shared: np.ndarray) -> Found:
    """Friction from the ratios of all break-aways, slides and turns so far.

    Args:
        static: Of the break-aways.
        slide: Of the slides.
        turn: Of the turns.
        r: Contact radius where no turn has shown it, (n,) [m].
        shared: Relative deviation of a ratio of forces that all samples share, (n,) [-].
    """
    ends = np.log([_surface(static, slide, turn, r, kind) for kind in (False, True)])
    shape = (ends[1] - ends[0]) ** 2 / 12.0
    noise = [1.0 / np.maximum(sums.weight, 1e-12) for sums in (static, slide, turn)]
    noise[2] = noise[2] + noise[1]
    known = np.array([static.weight > 0.0, slide.weight > 0.0, (slide.weight > 0.0) & (turn.weight > 0.0)])
    deviations = np.sqrt(shape + np.array(noise) + shared**2)
    return Found(np.where(known, np.exp(ends.mean(axis=0)), 1.0), np.where(known, deviations, np.inf))


def _surface(static: Ratios, slide: Ratios, turn: Ratios, r: np.ndarray, ellipsoid: bool) -> np.ndarray:
    """mu_s, mu_c and r on a limit surface, (3, n)."""
    p = ELLIPSOID if ellipsoid else DISC
    (f_s, tau_s), (f_c, tau_c), (f_r, tau_r) = (sums.means(ellipsoid) for sums in (static, slide, turn))
    seen = (slide.weight > 0.0) & (turn.weight > 0.0)
    # mu_c^p = f_c + tau_c / r^p = f_r + tau_r / r^p
    shown = np.maximum(f_c - f_r, 1e-9) / np.maximum(tau_r - tau_c, 1e-12)
    inverse = np.where(seen, np.clip(shown, LARGEST**-p, SMALLEST**-p), r**-p)
    mu_s, mu_c = f_s + tau_s * inverse, f_c + tau_c * inverse
    return np.array([mu_s, mu_c, 1.0 / inverse]) ** (1.0 / p)


def merge(observed: np.ndarray, deviations: np.ndarray, own: Found) -> tuple[np.ndarray, np.ndarray]:
    """Observed friction and one's own, each with the weight of its variance.

    Args:
        observed: mu_s, mu_c, r, (3, n).
        deviations: Their relative standard deviations, (3, n); 0 for friction that is known.
        own: What forces have shown.

    Returns:
        The values and their relative deviations, (3, n) each: the smaller of both, since both come from the
        same samples, and larger where they contradict each other.
    """
    square, other = deviations**2, np.minimum(own.deviations, 1e6) ** 2
    weight, gap = square / (square + other), np.log(own.values / observed)
    contradiction = np.maximum(np.abs(gap) / np.sqrt(square + other), 1.0)
    return observed * np.exp(weight * gap), np.minimum(deviations, own.deviations) * contradiction
