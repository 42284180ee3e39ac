"""The state fields that the shared functions need."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from estimator.estimate import COMMON_STATE

BUFFER_CAPACITY = 64
"""Largest n_b: the buffer travels inside the state, whose size is fixed."""

STICK_SLIP_STATE: list[tuple[Any, ...]] = [
    *COMMON_STATE,
    ("sd_mu_s", np.float64),
    ("sd_mu_c", np.float64),
    ("sd_r", np.float64),
    ("confidence_mu_s", np.float64),
    ("confidence_mu_c", np.float64),
    ("confidence_r", np.float64),
    ("events_mu_s", np.int64),
    ("updates_mu_c", np.int64),
    ("updates_r", np.int64),
    ("f_n", np.float64),
    ("halt_left", np.float64),
    ("still_samples", np.int64),
    ("slipping", np.bool_),
]
"""What most samples need: `f_n` the previous sample's [N], `halt_left` rest of a halt [s]."""

EVENT_STATE: list[tuple[Any, ...]] = [
    ("scatter_mu_s", np.float64),
    ("changes_mu_s", np.int64),
    ("gain_mu_s", np.float64),
    ("buffer_size", np.int64),
    ("buffer_next", np.int64),
    ("buffer", np.float64, (BUFFER_CAPACITY,)),
]
"""What stick and its end need; last in a state, out of the way of the rest. `scatter_mu_s`: variance of
one event, from `changes_mu_s` changes; `gain_mu_s`: weight of the last event; `buffer`: ring of force
ratios [-]."""


def start(parameters: NDArray[np.void], dtype: np.dtype[np.void]) -> NDArray[np.void]:
    """States before the first sample, but for an estimator's own fields: each value as its own doubt.

    Args:
        parameters: Structured array (m,).
        dtype: Holds STICK_SLIP_STATE.

    Returns:
        Structured array (m,).
    """
    states = np.zeros(len(parameters), dtype)
    for name in ("mu_s", "mu_c", "r"):
        states[name] = states[f"sd_{name}"] = parameters[f"{name}0"]
    return states
