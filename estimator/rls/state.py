"""Everything the "rls" estimator remembers between two samples."""

import numpy as np
from numpy.typing import NDArray

from estimator.stick_slip.state import EVENT_STATE, STICK_SLIP_STATE, start

STATE = np.dtype(
    [
        *STICK_SLIP_STATE,
        ("covariance_mu_c", np.float64),
        ("covariance_r", np.float64),
        ("residual_mu_c", np.float64),
        ("residual_r", np.float64),
        *EVENT_STATE,
    ],
    align=True,
)
"""`covariance_*`: P [1/N^2]; `residual_*`: mean square of the innovations of f_t [N^2], tau [N^2 m^2]."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States before the first sample.

    Args:
        parameters: Structured array (m,).

    Returns:
        Structured array (m,) of dtype STATE.
    """
    states = start(parameters, STATE)
    states["covariance_mu_c"] = parameters["p0"]
    states["covariance_r"] = parameters["p0"]
    return states
