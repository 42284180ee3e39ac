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
CHANGE, LEAST_CHANGE = 3, 0.4
"""Samples over which a load must change, and by how much at least [N], to show how stiff a pad is."""
SPARE = 2
"""Samples later than its delay by which a velocity may come."""
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

    The load changed some samples ago, and the late velocity has shown by now what motion that made. Whether a
    part of the motion was slip does not matter.
    """
    k, r = state.samples, max(state.r, 0.5 * p.r_max)
    after = state.delay + SPARE
    if state.in_a_row <= after + CHANGE:
        return
    now, before = state.wrenches[(k - after) & LAST], state.wrenches[(k - after - CHANGE) & LAST]
    force = max(norm(now[0] - before[0], now[1] - before[1]) - NOISE * p.sd_force, 0.0)
    change = norm(force, max(abs(now[3] - before[3]) - NOISE * p.sd_torque, 0.0) / r)
    if change < LEAST_CHANGE:
        return
    path = NOISE * p.sd_speed * p.sample_time * math.sqrt(after + CHANGE)
    for i in range(k - after - CHANGE + 1, k + 1):
        twist = state.twists[i & LAST]
        path += norm(norm(twist[0], twist[1]), r * twist[2]) * p.sample_time
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
    return longer_than_springs(state, p, p.compliance_max)


@njit(error_model="numpy")
def longer_than_springs(state, p, compliance):
    """Whether the motion is longer than twice what a pad springs by the whole load.

    Args:
        state: Record of the motion.
        p: Parameters.
        compliance: Of the pad in shear [m/N].
    """
    r, moved, spring = least_radius(state), 0.0, 0.0
    for j in range(3):
        noise, scale = (p.sd_force, 1.0) if j < 2 else (p.sd_torque, r)
        force = max(abs(state.lowest[j]), abs(state.highest[j])) + NOISE * noise
        moved += (state.moved_by[j] * scale) ** 2
        spring += (force / scale) ** 2
    return moved > (2.0 * compliance) ** 2 * spring
