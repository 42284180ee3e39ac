"""Everything the "ukf" estimator remembers between two samples."""

import numpy as np
from numpy.typing import NDArray

from estimator.sliding.state import SLIDING_STATE
from estimator.stick_slip.state import EVENT_STATE, start

STATE = np.dtype([*SLIDING_STATE, ("covariance", np.float64, (3,)), *EVENT_STATE], align=True)
"""`covariance`: of (ln mu_c, ln r), elements 11, 12, 22."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States before the first sample.

    Args:
        parameters: Structured array (m,).

    Returns:
        Structured array (m,) of dtype STATE.
    """
    states = start(parameters, STATE)
    states["covariance"][:, 0] = parameters["sd_log_mu_c0"] ** 2
    states["covariance"][:, 2] = parameters["sd_log_r0"] ** 2
    return states
