"""Reads sensors and friction for the controllers: means over both fingers, and a conservative prior."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from estimator.estimate import confidence_of
from policies.controllers.base import Columns


def both(columns: Columns, name: str) -> np.ndarray:
    """Mean of a sensor column over both fingers, (n,)."""
    return 0.5 * (columns[f"{name}_1"] + columns[f"{name}_2"])


def tangential(columns: Columns) -> np.ndarray:
    """Tangential force per finger, mean over both, (n,) [N]."""
    first, second = (np.hypot(columns[f"f_x_{f}"], columns[f"f_y_{f}"]) for f in (1, 2))
    return 0.5 * (first + second)


def scaled_load(columns: Columns, r: np.ndarray | float) -> np.ndarray:
    """Load per finger in the scaled norm of the limit surface, sqrt(f_t^2 + (tau / r)^2), (n,) [N]."""
    f_x, f_y, tau = (both(columns, name) for name in ("f_x", "f_y", "tau"))
    return np.sqrt(f_x**2 + f_y**2 + (tau / r) ** 2)


def scaled_speed(columns: Columns, r: np.ndarray | float) -> np.ndarray:
    """Scaled slip speed sqrt(v_t^2 + (r omega)^2), (n,) [m/s]."""
    v_x, v_y, omega = (both(columns, name) for name in ("v_x", "v_y", "omega"))
    return np.sqrt(v_x**2 + v_y**2 + (r * omega) ** 2)


@dataclass(frozen=True)
class ConservativePrior:
    """Friction that a controller assumes while the estimate has no confidence.

    The estimators' start values are optimistic: a controller that acts on them drops the object. Without
    confidence the prior replaces the estimate; in between the two are blended.

    The estimate is as often too high as too low. A grip that has to hold takes the lower quartile of friction
    instead: the estimate less 0.67 of its standard deviations, on the logarithm. It is never more cautious
    than the prior. An environment without deviations (`observation_mode="flat"`) gives the estimate itself.

    Raises:
        ValueError: A value is out of range.
    """

    mu_c: float = 0.3
    """Coulomb friction without confidence [-]; below that of the materials at hand."""
    r: float = 0.008
    """Contact radius without confidence [m]."""
    confidence: float = 0.1
    """Confidence from which an estimate is taken as it is, in (0, 1]; one update gives 0.02."""
    deviations: float = 0.67
    """Standard deviations below the estimate that a grip which has to hold takes [-]; 0: the estimate."""

    def __post_init__(self) -> None:
        """Check the ranges."""
        for name in ("mu_c", "r", "confidence"):
            value = getattr(self, name)
            if not 0.0 < value < np.inf:
                raise ValueError(f"{name} = {value!r} of a conservative prior must be finite and > 0")
        if not 0.0 <= self.deviations < np.inf:
            raise ValueError(
                f"deviations = {self.deviations!r} of a conservative prior must be finite and >= 0"
            )
        if self.confidence > 1.0:
            raise ValueError(f"confidence = {self.confidence!r} of a conservative prior must be at most 1")

    def confidence_weight(self, columns: Columns, name: str) -> np.ndarray:
        """Weight of the estimate of `name` against the prior, in [0, 1], (n,)."""
        return np.minimum(1.0, columns[f"confidence_{name}"] / self.confidence)

    def blend(self, columns: Columns, name: str) -> np.ndarray:
        """The friction value `name` of the observation ("mu_c" or "r"), blended with the prior, (n,)."""
        weight = self.confidence_weight(columns, name)
        return weight * columns[name] + (1.0 - weight) * getattr(self, name)

    def hold(self, columns: Columns, name: str) -> np.ndarray:
        """As `blend`, with the quantile in place of the estimate, for a grip that has to hold, (n,)."""
        weight, prior = self.confidence_weight(columns, name), getattr(self, name)
        return weight * self._quantile(columns, name, prior) + (1.0 - weight) * prior

    def blend_lever(self, columns: Columns) -> np.ndarray:
        """mu_c r, the torque per normal force in rotation, blended with the prior, at least it, (n,) [m].

        An estimate of r goes with the mu_c that it was found with, so r's confidence counts for both. Where
        the deviation of the product is known, it counts, if that is better.
        """
        return self._lever(columns, columns["mu_c"] * columns["r"])

    def hold_lever(self, columns: Columns) -> np.ndarray:
        """As `blend_lever`, with the quantile in place of the estimate, (n,) [m]."""
        value = columns["mu_c"] * columns["r"]
        return self._lever(columns, value * np.exp(-self.deviations * relative(columns, "lever", value)))

    def _lever(self, columns: Columns, value: np.ndarray) -> np.ndarray:
        weight, least = self.confidence_weight(columns, "r"), self.mu_c * self.r
        if "sd_lever" in columns:
            square = relative(columns, "lever", columns["mu_c"] * columns["r"]) ** 2
            known = np.minimum(1.0, confidence_of(square) / self.confidence)
            weight = np.maximum(weight, np.where(columns["confidence_mu_c"] > 0.0, known, 0.0))
        return np.maximum(least, weight * value + (1.0 - weight) * least)

    def _quantile(self, columns: Columns, name: str, least: float) -> np.ndarray:
        """The estimate less some of its deviations; not below `least`, unless the estimate is."""
        value = columns[name]
        cautious = value * np.exp(-self.deviations * relative(columns, name, value))
        return np.maximum(cautious, np.minimum(value, least))


def relative(columns: Columns, name: str, value: np.ndarray) -> np.ndarray:
    """Deviation of a value over the value, (n,); 0 if the environment does not show it."""
    if f"sd_{name}" not in columns:
        return np.zeros(len(columns))
    return columns[f"sd_{name}"] / np.maximum(value, 1e-9)


def Caution(mu_c: float = 0.3, r: float = 0.008, support: float = 0.1) -> ConservativePrior:
    """`ConservativePrior` by the names of version 0.1.0; warns."""
    warnings.warn(
        "Caution(support=...) is now ConservativePrior(confidence=...)", DeprecationWarning, stacklevel=2
    )
    return ConservativePrior(mu_c, r, support)
