"""Everything the "rls" estimator remembers between two samples."""

import numpy as np
from numpy.typing import NDArray

from estimator.estimate import COMMON_STATE

BUFFER_CAPACITY = 64
"""Largest n_b: the buffer travels inside the state, whose size is fixed."""

STATE = np.dtype(
    [
        *COMMON_STATE,
        ("covariance_mu_c", np.float64),
        ("covariance_r", np.float64),
        ("updates_mu_c", np.int64),
        ("updates_r", np.int64),
        ("events_mu_s", np.int64),
        ("f_n", np.float64),
        ("halt_left", np.float64),
        ("still_samples", np.int64),
        ("buffer_size", np.int64),
        ("buffer_next", np.int64),
        ("buffer", np.float64, (BUFFER_CAPACITY,)),
        ("slipping", np.bool_),
    ],
    align=True,
)
"""`f_n`: the previous sample's [N]; `halt_left`: rest of a halt [s]; `buffer`: ring of force ratios [-]."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States before the first sample.

    Args:
        parameters: Structured array (m,).

    Returns:
        Structured array (m,) of dtype STATE.
    """
    states = np.zeros(len(parameters), STATE)
    states["mu_s"] = parameters["mu_s0"]
    states["mu_c"] = parameters["mu_c0"]
    states["r"] = parameters["r0"]
    states["covariance_mu_c"] = parameters["p0"]
    states["covariance_r"] = parameters["p0"]
    return states
