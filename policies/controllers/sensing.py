"""What the controllers read: the mean of both fingers' sensors, and friction with caution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from policies.controllers.base import Columns


def both(columns: Columns, name: str) -> np.ndarray:
    """Mean of a sensor column over both fingers, (n,)."""
    return 0.5 * (columns[f"{name}_1"] + columns[f"{name}_2"])


def tangential(columns: Columns) -> np.ndarray:
    """Tangential force per finger, mean over both, (n,) [N]."""
    first, second = (np.hypot(columns[f"f_x_{f}"], columns[f"f_y_{f}"]) for f in (1, 2))
    return 0.5 * (first + second)


def scaled_load(columns: Columns, r: np.ndarray) -> np.ndarray:
    """Load per finger in the scaled norm of the limit surface, sqrt(f_t^2 + (tau / r)^2), (n,) [N]."""
    f_x, f_y, tau = (both(columns, name) for name in ("f_x", "f_y", "tau"))
    return np.sqrt(f_x**2 + f_y**2 + (tau / r) ** 2)


def scaled_speed(columns: Columns, r: np.ndarray) -> np.ndarray:
    """Scaled slip speed sqrt(v_t^2 + (r omega)^2), (n,) [m/s]."""
    v_x, v_y, omega = (both(columns, name) for name in ("v_x", "v_y", "omega"))
    return np.sqrt(v_x**2 + v_y**2 + (r * omega) ** 2)


@dataclass(frozen=True)
class Caution:
    """How a controller acts on friction values that no data supports yet.

    The estimator's start values are optimistic (mu_c 1.3); a controller that trusts them
    drops the object. Until an estimate is supported, a low friction takes its place; in
    between the two are blended.
    """

    mu_c: float = 0.3
    """Coulomb friction to assume without support [-]; below that of the materials at hand."""
    r: float = 0.008
    """Radius of the rim contact to assume without support [m]."""
    support: float = 0.1
    """Support from which an estimate is taken as it is, in (0, 1]; an update is worth 0.02."""

    def __post_init__(self) -> None:
        """Check the ranges."""
        for name in ("mu_c", "r", "support"):
            value = getattr(self, name)
            if not 0.0 < value < np.inf:
                raise ValueError(f"cautious {name} = {value!r} must be finite and > 0")
        if self.support > 1.0:
            raise ValueError(f"cautious support = {self.support!r} must be at most 1")

    def trust(self, columns: Columns, name: str) -> np.ndarray:
        """How far the friction value `name` is taken from the estimate, in [0, 1], (n,)."""
        return np.minimum(1.0, columns[f"confidence_{name}"] / self.support)

    def blend(self, columns: Columns, name: str) -> np.ndarray:
        """The friction value `name` of the observation ("mu_c" or "r"), with caution, (n,)."""
        trust = self.trust(columns, name)
        return trust * columns[name] + (1.0 - trust) * getattr(self, name)

    def blend_lever(self, columns: Columns) -> np.ndarray:
        """mu_c r, the torque per normal force in rotation, with caution and never below it, (n,) [m].

        An estimate of r goes with the mu_c that it was found with, so r's support counts for both.
        """
        trust, cautious = self.trust(columns, "r"), self.mu_c * self.r
        return np.maximum(cautious, trust * columns["mu_c"] * columns["r"] + (1.0 - trust) * cautious)
