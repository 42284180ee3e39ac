"""The result every estimator publishes, and the state fields they all share."""

from typing import Any, NamedTuple

import numpy as np


class Estimate(NamedTuple):
    """Contact properties of one finger after the newest sample.

    `updates_*` and `events_mu_s` count the data behind a value since the last reset; `support_*` puts that in
    [0, 1]: 0 is the start value, untouched; near 1 the start value is forgotten. Be cautious until it is.
    """

    mu_s: float
    """Static friction coefficient [-]."""
    mu_c: float
    """Coulomb friction coefficient [-]."""
    r: float
    """Radius of the equivalent rim contact [m]."""
    gamma_t: float
    """Share of translation in this sample: v_t / v or, at low speed, from the force [-]; 0 out of contact."""
    gamma_tau: float
    """Share of rotation in this sample: |r omega| / v or, at low speed, from the torque [-]."""
    confidence_mu_s: float
    """events_mu_s / (events_mu_s + 1) [-]."""
    confidence_mu_c: float
    """Share of mu_c's fading memory that is filled by data, 1 - forgetting**updates_mu_c [-]."""
    confidence_r: float
    """Share of r's fading memory that is filled by data, 1 - forgetting**updates_r [-]."""
    events_mu_s: int
    """Stick-slip events that set mu_s."""
    updates_mu_c: int
    """Samples that updated mu_c."""
    updates_r: int
    """Samples that updated r."""
    slipping: bool
    """State of the stick-slip machine."""
    halted: bool
    """Whether the heuristic held all updates back on this sample."""
    sd_mu_s: float
    """Standard deviation of mu_s [-], from the scatter of its events; untouched: as large as the value."""
    sd_mu_c: float
    """Standard deviation of mu_c [-], of noise alone; untouched: as large as the value."""
    sd_r: float
    """Standard deviation of r [m], of noise alone; untouched: as large as the value."""
    observable_mu_c: bool
    """Whether mu_c learnt on this sample."""
    observable_r: bool
    """Whether r learnt on this sample."""


ESTIMATE = np.dtype(list(Estimate.__annotations__.items()), align=True)
"""`Estimate` as a structured dtype: same names, same order."""

COMMON_STATE: list[tuple[Any, ...]] = [
    ("mu_s", np.float64),
    ("mu_c", np.float64),
    ("r", np.float64),
    ("t", np.float64),
    ("samples", np.int64),
]
"""Fields every state dtype begins with: the estimates, the last sample's time [s], how many were taken."""
