"""Decides whether friction has changed: the newest slips against the older ones, by the likelihood ratio.

Two memories: the states are those of the newest slips, and in the older ones ln mu_c differs by one more,
whose prior is narrow. Where the newest 0.15 s of slip contradict, the fit is repeated with a wide prior. If
that costs less by more than the Bayes factor of a rare change, the older slips are left to say what they can
of the other states.
"""

import math

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.sample import copy
from estimator.window.fit import descend, substitute
from estimator.window.layout import EMPTY, ENTRIES, MU, OLD, SLIDE, STATES
from estimator.window.residuals import slide

STEPS = 4  # Of a fit far from its start; as many first fits are
NEWEST = 0.155  # Slip time of the newest slips [s]: friction that changed is right again after it
ODDS = 8.0
"""Difference of the costs, twice the logarithm of the odds: a change is one in fifty slips beforehand. It is
tried from that squared deviation of the newest mean on."""


@njit(error_model="numpy")
def _newest(state, p, x):
    """Squared normalised mean residual of the newest slides along the slip, and what ln mu_c lacks there."""
    e, h, var = matrix(1, 3)[0], matrix(3, STATES), matrix(1, 3)[0]
    count, total, lacks = 1e-9, 0.0, 0.0
    for i in range(ENTRIES):
        s = state.entries[i]
        if s.kind != SLIDE or s.end < state.split or s.slides < 0.5:
            continue
        slide(x, s, p, state.sign, False, e, h, var)
        if abs(h[0, MU]) > 1e-6:
            along = e[0] if h[0, MU] > 0.0 else -e[0]
            total += min(max(along / math.sqrt(var[0]), -ODDS), ODDS)
            lacks += min(max(e[0] / h[0, MU], -0.7), 0.7)
            count += 1.0
    return total * total / count, lacks / count


@njit(error_model="numpy", forceinline=False)  # large, and called from several places
def fit(state, p):
    """Fits `x` and `covariance` to the window, and finds changes; a fit that fails changes nothing."""
    a, g = matrix(STATES, STATES), matrix(1, STATES)[0]
    x, other = matrix(1, STATES)[0], matrix(1, STATES)[0]
    if state.changed > 0.0 and state.slip_time > state.changed + p.memory:
        for i in range(ENTRIES):
            if state.entries[i].end < state.changed:
                state.entries[i].kind = EMPTY
        state.changed = 0.0
    changed = state.changed > 0.0
    state.split = state.changed if changed else state.slip_time - NEWEST
    copy(state.x, x)
    if not changed:
        x[OLD] = 0.0
    springs = state.springs
    cost, misfit = descend(state, p, x, changed, STEPS if state.fits < STEPS else 1, a, g)
    evidence, lacks = 0.0, 0.0
    if not changed and state.slip_time > 2.0 * NEWEST:
        evidence, lacks = _newest(state, p, x)
    if evidence > ODDS:
        cost, misfit = descend(state, p, x, False, 1, a, g)
        copy(x, other)
        other[MU] += lacks
        other[OLD] = -lacks
        found, off_found = descend(state, p, other, True, STEPS + 1, a, g)
        if found + ODDS < cost:
            state.changed, misfit = state.split, off_found
            copy(other, x)
        else:
            cost, misfit = descend(state, p, x, False, 1, a, g)
    if not math.isfinite(cost + misfit + state.springs):
        state.springs = springs
        return
    copy(x, state.x)
    for j in range(STATES):
        g[:] = 0.0
        g[j] = max(misfit, 1.0)
        substitute(a, g)
        for i in range(j, STATES):
            state.covariance[i, j] = state.covariance[j, i] = g[i]
    state.misfit, state.fit_time = misfit, state.t
    state.fits += 1
