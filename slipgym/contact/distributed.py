"""The distributed contact as an object, for a prescribed slip twist."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from slipgym.contact.distributed_kernel import prescribed_step
from slipgym.contact.ellipsoid import PrescribedContact
from slipgym.contact.pressure import MAX_CELLS, friction_axes, patch_cells, stretch
from slipgym.contact.records import LOAD, Z_X, Z_Y, Vector, X, Y, pads, patch, rest_cells
from slipgym.contact.validation import check_friction, positive


class DistributedContact(PrescribedContact):
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
        return self._pads["r"][0] * self._cells[[X, Y]].T / self._pads["axes"][0, ::-1]

    @property
    def shares(self) -> np.ndarray:
        """Copy of the fractions of the normal force that the loaded cells carry, shape (n,), sum 1."""
        return self._cells[LOAD].copy()

    @property
    def bristles(self) -> np.ndarray:
        """Copy of the loaded cells' bristle states z, shape (n, 2) [m]."""
        return self._cells[[Z_X, Z_Y]].T

    def reset(self) -> None:
        """Forget the bristle states, as after a loss of contact."""
        super().reset()
        rest_cells(self._cells)

    def _advance(self, v_x: float, v_y: float, omega: float, normal: float, dt: float) -> Vector:
        return prescribed_step(self._pads, self._cells, v_x, v_y, omega, normal, dt)

    def _resize(self, effective_radius: float, present: float) -> None:
        self._pads["r"] *= effective_radius / present
