"""A vector of three measurements in units of its own covariance."""

import math

from estimator._numba.caching import fused


@fused
def whitening(a, b, c, d, e, f):
    """Inverse (11, 21, 22, 31, 32, 33) of the Cholesky factor of a symmetric matrix (11, 12, 13, 22, 23, 33).

    It makes a vector with that covariance one with the covariance 1; NaN if the matrix is not positive.
    """
    x = 1.0 / math.sqrt(a)
    below, last = b * x, c * x
    y = 1.0 / math.sqrt(d - below * below)
    middle = (e - last * below) * y
    z = 1.0 / math.sqrt(f - last * last - middle * middle)
    turned = -below * x * y
    return x, turned, y, -(last * x + middle * turned) * z, -middle * y * z, z


@fused
def whitened(w, x, y, z):
    """The vector (x, y, z) times w from `whitening`."""
    return w[0] * x, w[1] * x + w[2] * y, w[3] * x + w[4] * y + w[5] * z


@fused
def weighted(w, x, y, z):
    """The vector (x, y, z) times the transpose of w from `whitening`."""
    return w[0] * x + w[1] * y + w[3] * z, w[2] * y + w[4] * z, w[5] * z
