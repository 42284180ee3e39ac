"""Computes the patch's friction step in plain numpy, for comparison with the compiled kernel."""

from __future__ import annotations

import numpy as np


class NumpyPatch:
    """The computation of `slipgym.contact.DistributedContact`, over whole arrays.

    Args:
        positions: Of the cells from the centre of pressure, shape (n, 2) [m].
        shares: Of the normal force, shape (n,), sum 1.
        mu_c: Coulomb friction [-].
        mu_s: Static friction [-].
        stribeck_velocity: Velocity v_s of the Stribeck curve [m/s].
        sigma_0: Bristle stiffness per normal force [1/m].
        sigma_1: Bristle damping per normal force [s/m].
        sigma_2: Viscous friction per normal force [s/m].
    """

    def __init__(
        self,
        positions: np.ndarray,
        shares: np.ndarray,
        mu_c: float = 0.4,
        mu_s: float = 0.55,
        stribeck_velocity: float = 1e-3,
        sigma_0: float = 1e6,
        sigma_1: float = 80.0,
        sigma_2: float = 0.2,
    ) -> None:
        self._position, self._share = positions.T.copy(), shares
        self._across = np.stack([-positions[:, 1], positions[:, 0]])
        self._mu_c, self._mu_s, self._stribeck_velocity = mu_c, mu_s, stribeck_velocity
        self._sigma_0, self._sigma_1, self._sigma_2 = sigma_0, sigma_1, sigma_2
        self._z, self._cap = np.zeros_like(self._position), np.zeros(len(shares))

    def step(self, twist: tuple[float, float, float], normal: float, h: float) -> np.ndarray:
        """Advance by h [s] at a twist [m/s, m/s, rad/s]; friction (f_x, f_y, tau) on it [N, N, N m]."""
        velocity = np.array(twist[:2])[:, None] + twist[2] * self._across
        speed = np.sqrt(np.einsum("an,an->n", velocity, velocity))
        capped = np.minimum(speed, self._cap)
        excess = np.exp(-((capped / self._stribeck_velocity) ** 2))
        reach = (self._mu_c + (self._mu_s - self._mu_c) * excess) / self._sigma_0
        start = self._z * self._shortening(self._z, reach)
        trial = start + h * velocity
        factor = self._shortening(trial, reach)
        self._z = trial * factor
        self._cap = np.where(factor < 1.0, np.inf, capped)
        force = self._sigma_0 * self._z + self._sigma_1 / h * (self._z - start) + self._sigma_2 * velocity
        force *= -normal * self._share
        return np.array([force[0].sum(), force[1].sum(), np.vdot(self._across, force)])

    @staticmethod
    def _shortening(z: np.ndarray, reach: np.ndarray) -> np.ndarray:
        """Factors (n,) that bring bristles (2, n) into their balls."""
        length = np.sqrt(np.einsum("an,an->n", z, z))
        return np.minimum(1.0, reach / np.maximum(length, 1e-300))
