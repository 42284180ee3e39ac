"""Everything the "joint" estimator remembers between two samples."""

import numpy as np
from numpy.typing import NDArray

from estimator.sliding.state import SLIDING_STATE
from estimator.stick_slip.state import EVENT_STATE, start

STATE = np.dtype(
    [
        *SLIDING_STATE,
        ("viscosity", np.float64),
        ("information", np.float64, (3,)),
        ("noise", np.float64, (3,)),
        ("vector", np.float64, (2,)),
        ("information_r", np.float64),
        ("noise_r", np.float64),
        *EVENT_STATE,
    ],
    align=True,
)
"""Weighted sums over samples (1, v) for (mu_c, viscosity): `information` (11, 12, 22), `noise` the same with
squared fading, `vector` the right-hand side; for r alike."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States before the first sample.

    Args:
        parameters: Structured array (m,).

    Returns:
        Structured array (m,) of dtype STATE.
    """
    states = start(parameters, STATE)
    weight = 1.0 / parameters["sd_mu_c0"] ** 2
    states["information"][:, 0] = states["noise"][:, 0] = weight
    states["vector"][:, 0] = weight * parameters["mu_c0"]
    states["information_r"] = states["noise_r"] = 1.0 / parameters["sd_r0"] ** 2
    return states
