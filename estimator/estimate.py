"""The result that every estimator publishes, and the state fields that all share."""

import warnings
from typing import Any, NamedTuple

import numpy as np


def confidence_of(square: Any) -> Any:
    """Confidence of a value whose squared relative standard deviation is known: one half at 10 % [-]."""
    return 1.0 / (1.0 + 100.0 * square)


def deviation_of(confidence: Any) -> Any:
    """Relative standard deviation behind a confidence in (0, 1], the inverse of `confidence_of` [-]."""
    return 0.1 * np.sqrt(1.0 / confidence - 1.0)


def _renamed(value: str) -> property:
    """A deprecated property `support_…`."""

    def read(self: "Estimate") -> float:
        message = f"Estimate.support_{value} is now Estimate.confidence_{value}"
        warnings.warn(message, DeprecationWarning, stacklevel=2)
        return getattr(self, f"confidence_{value}")

    return property(read, doc=f"Deprecated name of `confidence_{value}`.")


class Estimate(NamedTuple):
    """Contact properties of one finger after the newest sample.

    `updates_*` and `events_mu_s` count the data behind a value since the last reset. `confidence_*` maps that
    to [0, 1]: 0 is the untouched start value, near 1 data has replaced the start value. Do not act on a value
    before its confidence has grown.
    """

    mu_s: float
    """Static friction coefficient [-], never below mu_c; see also `confidence_mu_c`."""
    mu_c: float
    """Coulomb friction coefficient [-]."""
    r: float
    """Radius of the equivalent rim contact [m]."""
    gamma_t: float
    """Fraction of translation: v_t / v or, at low speed, from the force [-]; 0 out of contact."""
    gamma_tau: float
    """Fraction of rotation: |r omega| / v or, at low speed, from the torque [-]."""
    confidence_mu_s: float
    """events_mu_s / (events_mu_s + 1) [-]; "adaptive": as `confidence_mu_c`."""
    confidence_mu_c: float
    """Fraction of mu_c's fading memory that is filled by data, 1 - forgetting**updates_mu_c [-].

    "adaptive": 1 / (1 + (sd_mu_c / (0.1 mu_c))**2), one half at a deviation of 10 %; 0 before any update.
    """
    confidence_r: float
    """Fraction of r's fading memory that is filled by data, 1 - forgetting**updates_r [-]; "adaptive": as
    `confidence_mu_c`."""
    events_mu_s: int
    """Stick-slip events that set mu_s."""
    updates_mu_c: int
    """Samples that updated mu_c."""
    updates_r: int
    """Samples that updated r."""
    slipping: bool
    """State of the stick-slip machine."""
    halted: bool
    """Whether the heuristic halted all updates on this sample."""
    sd_mu_s: float
    """Standard deviation of mu_s [-], from the scatter of its events; initialised to the value itself."""
    sd_mu_c: float
    """Standard deviation of mu_c [-], due to noise alone but in "adaptive"; first the value itself."""
    sd_r: float
    """Standard deviation of r [m], due to noise alone but in "adaptive"; first the value itself."""
    sd_lever: float
    """Standard deviation of mu_c r [m], the torque per normal force of a spin: in a spin it is known before
    either factor is. "adaptive"; the others take both errors for independent."""
    observable_mu_c: bool
    """Whether this sample updated mu_c."""
    observable_r: bool
    """Whether this sample updated r."""

    support_mu_s = _renamed("mu_s")
    support_mu_c = _renamed("mu_c")
    support_r = _renamed("r")


ESTIMATE = np.dtype(list(Estimate.__annotations__.items()), align=True)
"""`Estimate` as a structured dtype: same names, same order."""

COMMON_STATE: list[tuple[Any, ...]] = [
    ("mu_s", np.float64),
    ("mu_c", np.float64),
    ("r", np.float64),
    ("t", np.float64),
    ("samples", np.int64),
]
"""First fields of every state dtype: the estimates, time of the last sample [s], number of samples."""
