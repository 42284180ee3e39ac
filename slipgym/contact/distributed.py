"""The distributed contact as an object, for a prescribed slip twist."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from slipgym.contact.patch import Law, patch_step
from slipgym.contact.pressure import MAX_CELLS, patch_cells
from slipgym.contact.validation import check_friction, finite_vector, positive


class DistributedContact:
    """Friction of a patch of cells, each a bristle with Stribeck effect and true stick.

    The limit surface is the pressure's own, not an ellipsoid; see `slipgym.contact.patch`
    for the equations and sources, `slipgym.contact.pressure` for the cells.

    Args:
        radius: Radius of the patch [m], > 0.
        cells: Cells along either side of the square around the patch, 1 to 201.
        pressure: "uniform", "hertz", "rim", or relative loads of the cells, shape
            (cells, cells), first index along x.
        mu_c: Coulomb friction [-], > 0.
        mu_s: Static friction [-], >= mu_c.
        stribeck_velocity: Velocity v_s of the Stribeck curve [m/s], > 0.
        stribeck_exponent: Exponent gamma of the Stribeck curve [-], > 0.
        sigma_0: Bristle stiffness per normal force [1/m], > 0.
        sigma_1: Bristle damping per normal force [s/m], >= 0.
        sigma_2: Viscous friction per normal force [s/m], >= 0.

    Raises:
        ValueError: A parameter is outside its range; the message names it.
    """

    def __init__(
        self,
        radius: float = 0.015,
        cells: int = 21,
        pressure: str | ArrayLike = "uniform",
        mu_c: float = 0.4,
        mu_s: float = 0.55,
        stribeck_velocity: float = 1e-3,
        stribeck_exponent: float = 2.0,
        sigma_0: float = 1e6,
        sigma_1: float = 80.0,
        sigma_2: float = 0.2,
    ) -> None:
        check_friction(mu_c, mu_s)
        positive(
            radius=radius,
            stribeck_velocity=stribeck_velocity,
            stribeck_exponent=stribeck_exponent,
            sigma_0=sigma_0,
        )
        positive(allow_zero=True, sigma_1=sigma_1, sigma_2=sigma_2)
        if not isinstance(cells, int | np.integer) or not 1 <= cells <= MAX_CELLS:
            raise ValueError(f"cells = {cells!r} must be a whole number from 1 to {MAX_CELLS}")
        numbers = (mu_c, mu_s, stribeck_velocity, stribeck_exponent, sigma_0, sigma_1, sigma_2)
        self._law = Law(*map(float, numbers))
        positions, shares = patch_cells(pressure, radius, int(cells))
        self._cells = np.array([*positions.T, shares])
        self._state = np.zeros_like(self._cells)

    @property
    def effective_radius(self) -> float:
        """Torque in steady pure spin over mu_c f_n, the radius of the equivalent rim contact [m]."""
        x, y, shares = self._cells
        return float(shares @ np.hypot(x, y))

    @property
    def positions(self) -> np.ndarray:
        """Copy of the loaded cells' positions from the centre of pressure, shape (n, 2) [m]."""
        return self._cells[:2].T.copy()

    @property
    def shares(self) -> np.ndarray:
        """Copy of the loaded cells' shares of the normal force, shape (n,), sum 1."""
        return self._cells[2].copy()

    @property
    def bristles(self) -> np.ndarray:
        """Copy of the loaded cells' bristle states z, shape (n, 2) [m]."""
        return self._state[:2].T.copy()

    def step(self, twist: Sequence[float], normal_force: float, dt: float) -> tuple[float, float, float]:
        """Advance by dt at a prescribed slip twist.

        Args:
            twist: Slip twist (v_x, v_y, omega) of the object relative to the pad at the
                centre of pressure, mean over the step [m/s, m/s, rad/s].
            normal_force: Normal force [N], >= 0.
            dt: Time step [s], > 0.

        Returns:
            Friction (f_x, f_y, tau) on the object at the step's end [N, N, N m].

        Raises:
            ValueError: A value is not finite or outside its range.
        """
        if len(twist) != 3 or not math.isfinite(twist[0] + twist[1] + twist[2]):
            finite_vector("twist", twist, 3)
        positive(allow_zero=True, normal_force=normal_force)
        positive(dt=dt)
        if normal_force == 0.0:
            self.reset()
            return 0.0, 0.0, 0.0
        v_x, v_y, omega = map(float, twist)
        return patch_step(
            self._law, self._cells, self._state, v_x, v_y, omega, float(normal_force), float(dt)
        )

    def change(self, mu_c: float, mu_s: float, effective_radius: float) -> None:
        """Change the friction and the size of the patch; its pressure profile and its bristles stay.

        Args:
            mu_c: Coulomb friction [-], > 0.
            mu_s: Static friction [-], >= mu_c.
            effective_radius: Radius of the equivalent rim contact [m], > 0.

        Raises:
            ValueError: A value is outside its range.
        """
        check_friction(mu_c, mu_s)
        positive(effective_radius=effective_radius)
        self._law = self._law._replace(mu_c=float(mu_c), mu_s=float(mu_s))
        self._cells[:2] *= effective_radius / self.effective_radius

    def reset(self) -> None:
        """Forget the bristle states, as after a loss of contact."""
        self._state[:] = 0.0
