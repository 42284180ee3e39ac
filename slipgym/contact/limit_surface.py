"""The steady limit surface of any pressure: a sum over cells, and a table of it.

In steady slip the friction of a cell opposes its velocity v_i = v + omega x x_i with mu_c w_i f_n
(Waltersson & Karayiannidis, arXiv 2308.01123; Goyal, Ruina & Papadopoulos, Planar sliding with dry
friction, Wear 143, 1991). The sum depends on the direction of the twist alone, two angles; the table
holds it on a grid of both.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from slipgym._numba.compiled import compiled

STILL = 1e-12
"""Speed of a point over that of the patch below which it does not move, but for rounding."""


class LimitSurface:
    """Steady friction over mu_c f_n of load at points, for every direction of slip.

    An example, of a patch whose load grows along x:

        contact = DistributedContact(cells=21, pressure=np.outer(np.arange(1, 22), np.ones(21)))
        surface = LimitSurface(contact.positions, contact.shares)
        f_x, f_y, tau = surface.wrench((0.02, 0.0, 1.5))

    Args:
        positions: Positions of the points from the centre of pressure, shape (n, 2) [m].
        shares: Fractions of the normal force at the points, shape (n,), >= 0, sum 1.
        intervals: Intervals of the table per quarter turn of each angle.

    Raises:
        ValueError: The shapes do not fit, shares are negative or do not add up to 1, or all points
            are at the centre of pressure.
    """

    def __init__(self, positions: ArrayLike, shares: ArrayLike, intervals: int = 60) -> None:
        self._positions, self._shares = np.asarray(positions, dtype=float), np.asarray(shares, dtype=float)
        if self._positions.shape != (*self._shares.shape, 2) or self._shares.ndim != 1:
            raise ValueError(
                f"positions must have shape (n, 2) and shares (n,), got {self._positions.shape} "
                f"and {self._shares.shape}"
            )
        if self._shares.min() < 0.0 or not math.isclose(self._shares.sum(), 1.0, rel_tol=1e-9):
            raise ValueError(f"shares must be >= 0 and add up to 1, got {self._shares.sum():g}")
        self._r = float(self._shares @ np.hypot(*self._positions.T))
        if not self._r > 0.0:
            raise ValueError("positions must not all be at the centre of pressure")
        self._step = 0.5 * math.pi / intervals
        tilts = self._step * np.arange(-intervals, intervals + 1)
        azimuths = self._step * np.arange(4 * intervals + 1)
        tilt, azimuth = np.meshgrid(tilts, azimuths, indexing="ij")
        planar = np.cos(tilt)
        twists = np.stack([planar * np.cos(azimuth), planar * np.sin(azimuth), np.sin(tilt) / self._r], -1)
        self._table = self.exact(twists.reshape(-1, 3)).reshape(*twists.shape)

    @property
    def effective_radius(self) -> float:
        """Torque in steady pure spin over mu_c f_n, the radius of the equivalent rim contact [m]."""
        return self._r

    def exact(self, twists: ArrayLike) -> np.ndarray:
        """The sum over all points.

        Args:
            twists: Slip twists (v_x, v_y, omega), shape (m, 3) or (3,) [m/s, m/s, rad/s].

        Returns:
            Friction (f_x, f_y, tau) on the object over mu_c f_n, same shape [-, -, m]. A point that
            does not move gives none.
        """
        array = np.asarray(twists, dtype=float)
        return _sums(self._positions, self._shares, self._r, array.reshape(-1, 3)).reshape(array.shape)

    def wrench(self, twists: ArrayLike) -> np.ndarray:
        """The same from the table, linear in both angles; as fast for many points as for few.

        Args:
            twists: As of `exact`; not zero.

        Returns:
            As `exact`.
        """
        array = np.asarray(twists, dtype=float)
        v_x, v_y, omega = array.reshape(-1, 3).T
        tilt = np.arctan2(self._r * omega, np.hypot(v_x, v_y)) / self._step + self._table.shape[0] // 2
        azimuth = np.arctan2(v_y, v_x) % (2.0 * math.pi) / self._step
        i = np.minimum(tilt.astype(int), self._table.shape[0] - 2)
        j = np.minimum(azimuth.astype(int), self._table.shape[1] - 2)
        a, b = (tilt - i)[:, None], (azimuth - j)[:, None]
        low = (1.0 - b) * self._table[i, j] + b * self._table[i, j + 1]
        high = (1.0 - b) * self._table[i + 1, j] + b * self._table[i + 1, j + 1]
        return ((1.0 - a) * low + a * high).reshape(array.shape)


@compiled
def _sums(positions: np.ndarray, shares: np.ndarray, r: float, twists: np.ndarray) -> np.ndarray:
    """Friction over mu_c f_n of points (n, 2) with shares (n,) at twists (m, 3), shape (m, 3)."""
    wrenches = np.zeros(twists.shape)
    for k in range(len(twists)):
        still = STILL * (abs(twists[k, 0]) + abs(twists[k, 1]) + abs(twists[k, 2]) * r)
        for i in range(len(shares)):
            x, y = positions[i, 0], positions[i, 1]
            v_x, v_y = twists[k, 0] - twists[k, 2] * y, twists[k, 1] + twists[k, 2] * x
            speed = math.sqrt(v_x * v_x + v_y * v_y)
            if speed > still:
                f_x, f_y = -shares[i] * v_x / speed, -shares[i] * v_y / speed
                wrenches[k, 0] += f_x
                wrenches[k, 1] += f_y
                wrenches[k, 2] += x * f_y - y * f_x
    return wrenches
