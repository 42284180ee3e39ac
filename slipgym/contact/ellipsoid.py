"""Contacts without cells as objects, for a prescribed slip twist: the ellipsoid and the disc."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from slipgym.contact.records import DISC, ELLIPSOID, Vector, pads, rest
from slipgym.contact.soft_kernel import prescribed_step
from slipgym.contact.validation import check_friction, finite_vector, positive


class PrescribedContact(ABC):
    """Friction of one pad, the first record of `_pads`, for a prescribed slip twist."""

    _pads: np.ndarray

    @property
    def effective_radius(self) -> float:
        """Radius r of the equivalent rim contact, torque in steady pure spin over mu_c f_n [m]."""
        return float(self._pads["r"][0])

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
        return self._advance(float(v_x), float(v_y), float(omega), float(normal_force), float(dt))

    def change(self, mu_c: float, mu_s: float, effective_radius: float) -> None:
        """Change the friction and the size of the contact; its pressure profile and its bristles stay.

        Args:
            mu_c: Coulomb friction [-], > 0.
            mu_s: Static friction [-], >= mu_c.
            effective_radius: Radius of the equivalent rim contact [m], > 0.

        Raises:
            ValueError: A value is outside its range, or the contact is a single cell, which has no radius.
        """
        check_friction(mu_c, mu_s)
        positive(effective_radius=effective_radius)
        present = self.effective_radius
        if present == 0.0:
            raise ValueError("a patch of one cell has no radius to change")
        self._pads["mu_c"], self._pads["mu_s"] = mu_c, mu_s
        self._resize(effective_radius, present)

    def reset(self) -> None:
        """Forget the bristle states, as after a loss of contact."""
        rest(self._pads)

    @abstractmethod
    def _advance(self, v_x: float, v_y: float, omega: float, normal: float, dt: float) -> Vector:
        """Friction after a step that `step` has checked."""

    def _resize(self, effective_radius: float, present: float) -> None:
        self._pads["r"] = effective_radius


class EllipsoidContact(PrescribedContact):
    """Friction of one pad with an ellipsoidal limit surface, Stribeck effect and true stick.

    The scaled twist (v_x, v_y, r omega) drives three bristle states; see
    `slipgym.contact.ellipsoid_kernel` for the equations and sources.

    Args:
        r: Radius of the equivalent rim contact [m], > 0.
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

    SURFACE = ELLIPSOID

    def __init__(
        self,
        r: float = 0.010,
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
            r=r, stribeck_velocity=stribeck_velocity, stribeck_exponent=stribeck_exponent, sigma_0=sigma_0
        )
        positive(allow_zero=True, sigma_1=sigma_1, sigma_2=sigma_2)
        self._pads = pads(
            1,
            r=r,
            mu_c=mu_c,
            mu_s=mu_s,
            stribeck_velocity=stribeck_velocity,
            stribeck_exponent=stribeck_exponent,
            sigma_0=sigma_0,
            sigma_1=sigma_1,
            sigma_2=sigma_2,
            surface=self.SURFACE,
        )

    @property
    def bristles(self) -> np.ndarray:
        """Copy of the bristle state z in scaled displacement (x, y, r theta), shape (3,) [m]."""
        return self._pads["z"][0].copy()

    def _advance(self, v_x: float, v_y: float, omega: float, normal: float, dt: float) -> Vector:
        self._pads["normal"] = normal
        prescribed_step(self._pads[0], np.array((v_x, v_y, omega)), dt)
        f_x, f_y, tau = self._pads["wrench"][0].tolist()
        return f_x, f_y, tau


class DiscContact(EllipsoidContact):
    """`EllipsoidContact` with the limit surface of a uniformly loaded disc of radius 3 r / 2.

    The surface is tabulated from the exact one (`slipgym.contact.disc_surface`). In contrast to
    `DistributedContact` the disc sticks or slips as a whole.
    """

    SURFACE = DISC
