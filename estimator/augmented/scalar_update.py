"""The Kalman update of the states of "adaptive" by one scalar measurement."""

from estimator._numba.caching import njit
from estimator.augmented.slip_law import STATES


@njit(error_model="numpy")
def correct(x, covariance, crossed, weight, innovation):
    """Moves the states by crossed weight innovation, and lowers their covariance by crossed crossed' weight.

    Args:
        x: (12,) states, changed in place; bounds are the caller's.
        covariance: (12, 12), changed in place; it stays symmetric bit for bit.
        crossed: (12,), covariances of the states with the measurement; not a view of `covariance`.
        weight: 1 / variance of the innovation; a smaller one removes less of the covariance.
        innovation: Measurement less its expectation.
    """
    for j in range(STATES):
        x[j] += crossed[j] * weight * innovation
        for k in range(STATES):
            covariance[j, k] -= crossed[j] * crossed[k] * weight
