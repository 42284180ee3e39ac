"""A motion under a load that friction has held before is the spring of the pad, not a slip.

In torsion a pad springs by its compliance over r^2, and a change of the torque that does so may be less than
the torque's noise: neither the direction nor the length of such a motion shows what it is. The load does:
a contact slides at mu_c f_n, and mu_c is neither far below what it has held nor far below what pads show.
"""

import math

from estimator._numba.caching import njit
from estimator.augmented.slip_law import R
from estimator.augmented.timing import LAST
from estimator.limit_surface.inverse import load_size
from estimator.sample import norm

AT_LEAST = 0.4
"""Smallest ratio of mu_c and mu_s."""
LOAD_EXPONENT = 0.35
"""Largest exponent with which friction falls with the normal force."""
FADING = 0.993
"""Factor of what was held per `estimator.augmented.deviation.EVERY` samples: friction changes, too."""
LOWEST = 2.0
"""Deviations below its start value of the smallest mu_c and r that are expected."""
NEWEST = 4
"""Newest samples of which one must carry the load: the velocity is late."""
LEAST_CHANGE = 0.2
"""Change of the load from which a pad shows how stiff it is [N]."""
SAFETY = 1.5
"""Compliance that is assumed, over that which a motion shows."""
NOISE = 3.0
"""Deviations of the noise by which a force may be off."""


@njit(error_model="numpy")
def hold(state, p, f_t, f_n):
    """Keeps the largest ratio of tangential to normal force [N] that the contact has carried."""
    state.held *= FADING
    ratio = (f_t - NOISE * p.sd_force) / (f_n + NOISE * p.sd_normal)
    if ratio > state.held:
        state.held, state.held_load = ratio, f_n


@njit(error_model="numpy")
def stiffen(state, p):
    """Lowers the compliance that is assumed: a pad springs no further than the object moves.

    The load changed between the ends of a window and its middle; the late velocity shows the
    motion by its end. Whether a part of the motion was slip does not matter.
    """
    if state.in_a_row <= LAST:
        return
    k, path = state.samples, NOISE * p.sd_speed * p.sample_time * LAST**0.5
    first, middle = state.wrenches[(k - LAST) & LAST], state.wrenches[(k - LAST // 2) & LAST]
    change = max(norm(middle[0] - first[0], middle[1] - first[1]) - NOISE * p.sd_force, 0.0)
    change = norm(change, max(abs(middle[3] - first[3]) - NOISE * p.sd_torque, 0.0) / state.r)
    if change < LEAST_CHANGE:
        return
    for i in range(k - LAST + 1, k + 1):
        twist = state.twists[i & LAST]
        path += norm(norm(twist[0], twist[1]), state.r * twist[2]) * p.sample_time
    state.spring = max(min(state.spring, SAFETY * path / change), p.compliance)


@njit(error_model="numpy")
def least_friction(state, p, f_n):
    """Smallest mu_c that is plausible at a normal force [N]."""
    held = AT_LEAST * state.held
    if f_n > state.held_load > 0.0:
        held *= (state.held_load / f_n) ** LOAD_EXPONENT
    return max(held, p.mu_c0 * math.exp(-LOWEST * p.sd_log_mu_c0))


@njit(error_model="numpy")
def least_radius(state):
    """Smallest r that is plausible [m]."""
    return state.r * math.exp(-LOWEST * math.sqrt(state.covariance[R, R]))


@njit(error_model="numpy")
def may_slide(state, p):
    """Whether the newest load is one at which a contact may slide, or the motion too long for any pad."""
    k, r = state.samples, least_radius(state)
    for i in range(k - NEWEST + 1, k + 1):
        w = state.wrenches[i & LAST]
        load = load_size(True, norm(w[0], w[1]), abs(w[3]) / r)
        if load > w[2] * least_friction(state, p, w[2]):
            return True
    moved, spring = 0.0, 0.0
    for j in range(3):
        noise, scale = (p.sd_force, 1.0) if j < 2 else (p.sd_torque, r)
        force = max(abs(state.lowest[j]), abs(state.highest[j])) + NOISE * noise
        moved += (state.moved_by[j] * scale) ** 2
        spring += (force / scale) ** 2
    return moved > (2.0 * p.compliance_max) ** 2 * spring
