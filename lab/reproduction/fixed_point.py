"""The coupling of mu_c and r in the estimator, as a map, for one steady slip on the ellipsoid.

Waltersson & Karayiannidis, arXiv 2507.06824, end of section 2. In the paper's map T, r and the
gammas follow from the given mu_c at once; what the estimator does is explicit: each step uses
the r of the step before.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from estimator.limit_surface import DISC_RADIUS, disc_friction


@dataclass(frozen=True)
class Slip:
    """A steady slip with known truth."""

    gamma_t: float
    """True share of translation, in (0, 1) [-]."""
    mu_c: float = 0.4
    """True Coulomb friction [-]."""
    r: float = 0.010
    """True radius of the rim contact [m]."""
    f_n: float = 5.0
    """Normal force [N]."""
    speed: float = 0.02
    """Scaled slip speed [m/s]."""

    @property
    def v_t(self) -> float:
        """Translation speed [m/s]."""
        return self.gamma_t * self.speed

    @property
    def omega(self) -> float:
        """Spin [rad/s]."""
        return np.sqrt(1.0 - self.gamma_t**2) * self.speed / self.r

    @property
    def f_t(self) -> float:
        """Tangential force (eq. 1) [N]."""
        return self.gamma_t * self.mu_c * self.f_n

    @property
    def tau(self) -> float:
        """Torque (eq. 2) [N m]."""
        return np.sqrt(1.0 - self.gamma_t**2) * self.mu_c * self.f_n * self.r


def radius_of(slip: Slip, mu_c: np.ndarray) -> np.ndarray:
    """The r that solves r gamma_tau(r) = tau / (mu_c f_n), with gamma_tau = r omega / v [m].

    With rho = tau / (mu_c f_n) this is r^4 omega^2 = rho^2 (v_t^2 + r^2 omega^2).
    """
    rho2 = (slip.tau / (mu_c * slip.f_n)) ** 2
    return np.sqrt(0.5 * (rho2 + np.sqrt(rho2**2 + 4.0 * rho2 * (slip.v_t / slip.omega) ** 2)))


def paper_map(slip: Slip, mu_c: np.ndarray) -> np.ndarray:
    """The paper's T(mu_c) = f_t / (f_n gamma_t(r(mu_c))) [-]."""
    gamma_t = slip.v_t / np.hypot(slip.v_t, radius_of(slip, mu_c) * slip.omega)
    return slip.f_t / (slip.f_n * gamma_t)


def slope(slip: Slip, step: float = 1e-6) -> float:
    """T' at the true mu_c, by central difference; truncation and rounding are below 1e-9 [-]."""
    around = slip.mu_c * np.array([1.0 + step, 1.0 - step])
    high, low = paper_map(slip, around)
    return float((high - low) / (around[0] - around[1]))


def slope_closed_form(gamma_t: float) -> float:
    """T'(mu*) = -(1 - c^2) / (1 + c^2), c the true gamma_t [-]."""
    return -(1.0 - gamma_t**2) / (1.0 + gamma_t**2)


def explicit_iteration(slip: Slip, r0: float, gain: float, steps: int) -> np.ndarray:
    """The estimator's own order with RLS gain kappa: mu_c, then r, each from the r before.

    At full gain r_{k+1} = r*^2 / r_k, which oscillates for ever; near the truth the error is
    multiplied by 1 - 2 kappa.

    Args:
        slip: The slip.
        r0: Start value [m].
        gain: Share kappa of the new value taken, in (0, 1].
        steps: How many.

    Returns:
        r after each step, (steps + 1,) [m].
    """
    radii = [r0]
    for _ in range(steps):
        r = radii[-1]
        v = np.hypot(slip.v_t, r * slip.omega)
        mu_c = slip.f_t * v / (slip.v_t * slip.f_n)
        new = slip.tau * v / (r * slip.omega * mu_c * slip.f_n)
        radii.append(r + gain * (new - r))
    return np.array(radii)


def disc_bias(gamma_t: float, viscous: float = 0.0) -> tuple[float, float]:
    """Relative errors of mu_c and r at which the ellipsoid's equations rest on a uniform disc.

    The disc's exact wrench takes the place of f_t and tau in r^2 = tau v_t / (f_t omega) and
    (mu_c f_n)^2 = f_t^2 + (tau / r)^2. Viscous friction adds sigma_2 v_t f_n to f_t and, integrated
    over the disc of radius R, sigma_2 omega f_n R^2 / 2 to tau.

    Args:
        gamma_t: Share of translation at the disc's true r = 2R/3, in (0, 1) [-].
        viscous: sigma_2 v / mu_c, v the scaled speed at the true r [-].
    """
    gamma_tau = np.sqrt(1.0 - gamma_t**2)
    v_t, omega = gamma_t, gamma_tau / DISC_RADIUS  # R, v, mu_c and f_n are 1
    force, torque = disc_friction(v_t / omega)
    f_t, tau = force + viscous * v_t, torque + viscous * omega / 2.0
    r = np.sqrt(tau * v_t / (f_t * omega))
    return float(np.hypot(f_t, tau / r)) - 1.0, float(r / DISC_RADIUS) - 1.0
