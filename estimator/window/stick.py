"""Computes the residual of a load at the limit of stick, before a slip or after its fall.

On the limit surface the size of the load over f_n is mu_s before the break-away, and mu_c after the
fall of the force. Only the size is compared: the velocity, which is late, does not matter.
"""

import math

from estimator._numba.caching import njit
from estimator.window import layout as at

SAMPLING = 0.08
"""Relative deviation of one event: the load is read between ramp and fall, the largest of noisy samples
counts, and friction depends on the place and on the time in stick by some per cent."""
FLATTER = 0.27
"""How much ln of the size on a disc exceeds that on the ellipsoid, over share (1 - share) of the torque."""


@njit(error_model="numpy")
def stick(x, s, old, of_r, e, h, var):
    """Residual of ln (load / f_n), derivatives and variance, in the first row of the outputs of `slide`.

    The load before a slip says what mu_s is, not what mu_c is: one that is wrong must not pull the other.
    `of_r`: variance of ln r, by which the size of a torque is uncertain then.
    """
    f_n = s.wrench[2]
    f_x, f_y = (
        s.wrench[0] - x[at.ZERO] - f_n * x[at.TILT],
        s.wrench[1] - x[at.ZERO + 1] - f_n * x[at.TILT + 1],
    )
    tau = s.wrench[3] - x[at.TORQUE] - x[at.COP] * f_y + x[at.COP + 1] * f_x
    r = math.exp(x[at.R] + x[at.GROWS] * s.load)
    rim = (tau / r) ** 2
    square = f_x * f_x + f_y * f_y + rim + 1e-9
    share = rim / square
    expected = x[at.MU] - x[at.FALLS] * s.load + (x[at.OLD] if old else 0.0)
    expected += 0.25 * s.unknown if s.kind == at.FALL else x[at.RATIO]
    e[0] = 0.5 * math.log(square) - math.log(f_n) + FLATTER * x[at.SHAPE] * share * (1.0 - share) - expected
    for j in range(at.STATES):
        h[0, j] = 0.0
    unsure = (0.1 * share) ** 2
    if s.kind == at.BREAK:
        h[0, at.RATIO] = 1.0
        unsure += share * share * of_r
    else:
        h[0, at.MU], h[0, at.FALLS], h[0, at.R] = 1.0, -s.load, share
        if old:
            h[0, at.OLD] = 1.0
        for j in range(2):
            f = f_x if j == 0 else f_y
            h[0, at.ZERO + j], h[0, at.TILT + j] = f / square, f_n * f / square
    var[0] = SAMPLING * SAMPLING + (0.05 / f_n) ** 2 + s.var_force / square + unsure
    var[0] += (0.2 * s.unknown) ** 2 + share * share * s.var_torque / (tau * tau + 1e-12)
