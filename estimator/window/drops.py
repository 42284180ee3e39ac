"""Learns from sudden falls of the load where no slip velocity is measured: a slip that begins shows as one.

At the onset of a slip friction falls from mu_s to mu_c times the normal force, within a sample or two. A push
that ends looks the same, and so does a sudden stop of the wrist. So a fall counts only if the load over the
normal force was about as large as any that held before, and if it is no larger than mu_s over mu_c can be.
One fall alone is still weak evidence, and several that agree are less so. The error of the normal force is
common to all, so that no number of them makes the deviation smaller than that.
"""

import math

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.estimate import confidence_of
from estimator.sample import norm
from estimator.window.layout import SAMPLES

FALL = 0.08
"""Least fall of the load that is a slip, over the load: mu_c is below mu_s by more than that."""
MOST, LIKE = 0.4, 0.85
"""Largest fall, over the load; least load over normal force before it, over the largest that held so far."""
FIRM = 5.0
"""Normal force from which that counts, over the least in contact."""
SIGMAS = 4.0
"""The same over the noise of its measurement."""
EITHER = 0.25
"""Deviation of ln mu that a single fall leaves, as it may be none of a slip [-]."""
APART = 24
"""Samples after a fall without another one: the grip closes and opens again."""
_confidence = njit(confidence_of)


@njit(error_model="numpy")
def _load(state, first):
    """Mean tangential and normal force and |torque| of the samples first and first + 1 before the newest."""
    mean = matrix(1, 4)[0]
    mean[:] = 0.0
    for back in (first, first + 1):
        wrench = state.wrenches[(state.samples - back) % SAMPLES]
        for j in range(4):
            mean[j] += 0.5 * (wrench[j] - state.zeros[j] if j != 2 else wrench[j])
    return norm(mean[0], mean[1]), mean[2], abs(mean[3])


@njit(error_model="numpy")
def learn_drop(state, p):
    """Looks for a fall of the load at the newest sample, the sixth in contact or a later one."""
    if state.quiet > 0:
        state.quiet -= 1
    if state.in_a_row < 6 or state.quiet > 0:
        return
    before, normal, _ = _load(state, 4)
    falling, _, _ = _load(state, 1)
    now, pressed, torque = _load(state, 0)  # one sample later, when it has fallen
    noise = SIGMAS * p.sd_force
    ratio = before / max(normal, 1e-9)
    largest = state.drop_largest
    if normal > FIRM * p.eps_fn:
        state.drop_largest = max(largest, ratio)
    fell = before - max(falling, now) > max(FALL * before, noise) and pressed > p.eps_fn
    fell &= ratio > LIKE * largest and now > (1.0 - MOST) * before
    if not fell or now < noise or torque > 0.3 * p.r0 * now + SIGMAS * p.sd_torque:
        return
    state.quiet = APART
    weight = 1.0 / (EITHER**2 + 0.5 * (p.sd_force / now) ** 2 + 0.5 * (p.sd_normal / pressed) ** 2)
    state.drops += weight
    share = weight / (state.drops + 1.0 / p.sd_log_mu_c0**2)
    if state.updates_mu_c == 0:
        state.drop_mean, state.drop_static = math.log(p.mu_c0), math.log(p.mu_s0)
    state.drop_mean += share * (math.log(now / pressed) - state.drop_mean)
    state.drop_static += share * (math.log(before / normal) - state.drop_static)
    square = 1.0 / (state.drops + 1.0 / p.sd_log_mu_c0**2) + p.sd_gain**2
    state.mu_c = min(max(math.exp(state.drop_mean), p.mu_min), p.mu_max)
    state.mu_s = min(max(math.exp(state.drop_static), state.mu_c), p.mu_max)
    state.sd_mu_c, state.sd_mu_s = state.mu_c * math.sqrt(square), state.mu_s * math.sqrt(square)
    state.confidence_mu_c = state.confidence_mu_s = _confidence(square)
    state.updates_mu_c += 1
    state.events_mu_s += 1
