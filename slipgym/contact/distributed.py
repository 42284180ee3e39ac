"""The distributed contact as an object, for a prescribed slip twist."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from slipgym.contact.anisotropy import friction_axes, stretch
from slipgym.contact.distributed_kernel import prescribed_step
from slipgym.contact.pressure import MAX_CELLS, patch_cells
from slipgym.contact.records import LOAD, Z_X, Z_Y, X, Y, pads, patch, rest, rest_cells
from slipgym.contact.validation import check_friction, finite_vector, positive


class DistributedContact:
    """Friction of a patch of cells, each a bristle with Stribeck effect and true stick.

    The limit surface is the pressure's own, not an ellipsoid; see `slipgym.contact.distributed_kernel`
    for the equations and sources, `slipgym.contact.pressure` for the cells.

    Args:
        radius: Radius of the patch [m], > 0.
        cells: Cells along either side of the square around the patch, 1 to 201.
        pressure: "uniform", "hertz", "rim", "punch", or relative loads of the cells, shape
            (cells, cells), first index along x.
        mu_c: Coulomb friction [-], > 0.
        mu_s: Static friction [-], >= mu_c.
        stribeck_velocity: Velocity v_s of the Stribeck curve [m/s], > 0.
        stribeck_exponent: Exponent gamma of the Stribeck curve [-], > 0.
        sigma_0: Bristle stiffness per normal force [1/m], > 0.
        sigma_1: Bristle damping per normal force [s/m], >= 0.
        sigma_2: Viscous friction per normal force [s/m], >= 0.
        anisotropy: Friction along x is larger by this fraction, along y smaller [-], in (-0.5, 0.5).

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
        anisotropy: float = 0.0,
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
        if not -0.5 < anisotropy < 0.5:
            raise ValueError(f"anisotropy = {anisotropy!r} must be in (-0.5, 0.5)")
        self._pads = pads(
            1,
            r=radius,  # the cells' unit of length; their own r is 0 if there is but one
            mu_c=mu_c,
            mu_s=mu_s,
            stribeck_velocity=stribeck_velocity,
            stribeck_exponent=stribeck_exponent,
            sigma_0=sigma_0,
            sigma_1=sigma_1,
            sigma_2=sigma_2,
        )
        self._radius = float(radius)
        self._cells = patch(*patch_cells(pressure, int(cells)))
        if anisotropy:
            self._pads["axes"] = friction_axes(float(anisotropy))
            stretch(self._cells, self._pads["axes"][0])

    @property
    def effective_radius(self) -> float:
        """Torque in steady pure spin over mu_c f_n, the radius of the equivalent rim contact [m]."""
        return float(self.shares @ np.hypot(*self.positions.T))

    @property
    def positions(self) -> np.ndarray:
        """Copy of the loaded cells' positions from the centre of pressure, shape (n, 2) [m]."""
        return self._radius * self._cells[[X, Y]].T / self._pads["axes"][0, ::-1]

    @property
    def shares(self) -> np.ndarray:
        """Copy of the fractions of the normal force that the loaded cells carry, shape (n,), sum 1."""
        return self._cells[LOAD].copy()

    @property
    def bristles(self) -> np.ndarray:
        """Copy of the loaded cells' bristle states z, shape (n, 2) [m]."""
        return self._cells[[Z_X, Z_Y]].T

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
        v_x, v_y, omega = twist if len(twist) == 3 else finite_vector("twist", twist, 3)
        if not (math.isfinite(v_x + v_y + omega) and 0.0 <= normal_force < math.inf and 0.0 < dt < math.inf):
            finite_vector("twist", twist, 3)
            positive(allow_zero=True, normal_force=normal_force)
            positive(dt=dt)
        if normal_force == 0.0:
            self.reset()
            return 0.0, 0.0, 0.0
        return prescribed_step(
            self._pads, self._cells, float(v_x), float(v_y), float(omega), float(normal_force), float(dt)
        )

    def change(self, mu_c: float, mu_s: float, effective_radius: float) -> None:
        """Change the friction and the size of the patch; its pressure profile and its bristles stay.

        Args:
            mu_c: Coulomb friction [-], > 0.
            mu_s: Static friction [-], >= mu_c.
            effective_radius: Radius of the equivalent rim contact [m], > 0.

        Raises:
            ValueError: A value is outside its range, or the patch is a single cell, which has no radius.
        """
        check_friction(mu_c, mu_s)
        positive(effective_radius=effective_radius)
        present = self.effective_radius
        if present == 0.0:
            raise ValueError("a patch of one cell has no radius to change")
        self._pads["mu_c"], self._pads["mu_s"] = mu_c, mu_s
        self._radius *= effective_radius / present
        self._pads["r"] = self._radius

    def reset(self) -> None:
        """Forget the bristle states, as after a loss of contact."""
        rest(self._pads)
        rest_cells(self._cells)
