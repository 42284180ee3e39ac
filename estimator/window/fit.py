"""Fits the states to the window: Gauss-Newton with robust weights and probabilities of a slip.

What is known of the states without any slip are normal distributions, with heavier tails for the exponents.
"""

import math

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.window import layout as at
from estimator.window.layout import FALLS, GROWS, OLD, STATES
from estimator.window.residuals import slide, stick

TAILS = 2.0
"""Squared normalised residual at which an entry counts half: Cauchy, as in the Student distribution with few
degrees of freedom."""
HARD, RUBBER = 0.045, 0.12
"""Half width of the exponents' Cauchy distribution for a hard pad, and for one that may be rubber: silicones
have exponents of -0.1 to 0.4."""
DRIFT, CHANGE = 0.03, 0.5  # Deviation of the newest slips from the older ones: without a change, and with one


@njit(error_model="numpy")
def factor(a):
    """Replaces the lower triangle of a (15, 15) by its Cholesky factor; False if it has none."""
    for i in range(STATES):
        for j in range(i + 1):
            rest = a[i, j]
            for k in range(j):
                rest -= a[i, k] * a[j, k]
            if i > j:
                a[i, j] = rest / a[j, j]
            elif rest > 0.0:
                a[i, i] = math.sqrt(rest)
            else:
                return False
    return True


@njit(error_model="numpy")
def substitute(a, g):
    """Replaces g (15,) by the solution of L L' x = g."""
    for i in range(STATES):
        for k in range(i):
            g[i] -= a[i, k] * g[k]
        g[i] /= a[i, i]
    for i in range(STATES - 1, -1, -1):
        for k in range(i + 1, STATES):
            g[i] -= a[k, i] * g[k]
        g[i] /= a[i, i]


@njit(error_model="numpy")
def _gather(state, p, x, a, g):
    """Writes the normal equations of all entries at x, `a` below its diagonal, and the share of springs.

    Returns:
        Cost of the entries, and mean squared normalised residual of the slides.

    """
    e, h, var = matrix(1, 3)[0], matrix(3, STATES), matrix(1, 3)[0]
    g[:] = 0.0
    a[:] = 0.0
    cost, total, count, springs, weights = 0.0, 0.0, 1e-9, 0.0, 1e-9
    for i in range(at.ENTRIES):
        s = state.entries[i]
        kind, rows = s.kind, 1
        if kind == at.EMPTY:
            continue
        old = s.end < state.split
        if kind == at.SLIDE:
            rows = 3
            slide(x, s, p, state.sign, old, e, h, var)
        else:
            stick(x, s, p, old, state.covariance[at.R, at.R], e, h, var)
        q = 0.0
        for k in range(rows):
            q += e[k] * e[k] / (rows * var[k])
        weight, loss = math.exp((s.end - state.slip_time) / p.memory), TAILS * rows * math.log1p(q / TAILS)
        if kind == at.SLIDE:
            total += weight * s.slides * min(q, TAILS * TAILS)
            count += weight * s.slides
        weights += weight
        # a pad springs under any load up to the limit, and under none beyond it
        if kind == at.BREAK or e[0] * (state.sign if kind == at.SLIDE else 1.0) > 0.0:
            cost += weight * loss
        else:
            spread = var[0] + h[0, at.MU] ** 2 * state.covariance[at.MU, at.MU]
            odds = s.slides / (1.0 - s.slides)
            odds *= (abs(h[0, at.MU]) + 1e-3) / math.sqrt(2.0 * math.pi * spread)
            cost -= 2.0 * weight * math.log((odds * math.exp(-0.5 * loss) + 1.0) / (odds + 1.0))
            likely = odds * math.exp(-0.5 * e[0] * e[0] / spread)
            springs += weight / (likely + 1.0)
            weight *= likely / (likely + 1.0)
        weight /= 1.0 + q / TAILS
        for k in range(rows):
            information, off = weight / var[k], e[k]
            for j in range(STATES):
                by = information * h[k, j]
                if by != 0.0:  # most derivatives are
                    g[j] += by * off
                    for m in range(j + 1):
                        a[j, m] += by * h[k, m]
    state.springs = springs / weights
    return cost, total / count


@njit(error_model="numpy")
def _add_priors(state, p, x, changed, a, g):
    """Adds the information of the priors to the normal equations, and returns their cost.

    A Cauchy distribution of half width s has the cost 2 ln(1 + (x / s)^2), whose gradient is that of a normal
    distribution with the variance (s^2 + x^2) / 2. `changed`: whether friction has changed since the older
    slips.
    """
    cost, width = 0.0, HARD if state.spring <= p.compliance else RUBBER
    for j in range(STATES):
        off, variance = x[j] - state.mean[j], state.variance[j]
        if j == OLD:
            variance = (CHANGE if changed else DRIFT) ** 2
        if j in (FALLS, GROWS):
            variance = 0.5 * (width * width + off * off)
            cost += 2.0 * math.log1p((off / width) ** 2)
        else:
            cost += off * off / variance
        a[j, j] += 1.0 / variance
        g[j] -= off / variance
    return cost


@njit(error_model="numpy")
def _limit(p, x):
    """Keeps the states where the law is meant for."""
    x[at.MU] = min(max(x[at.MU], math.log(p.mu_min)), math.log(p.mu_max))
    x[at.RATIO] = min(max(x[at.RATIO], 0.0), -math.log(at.AT_LEAST))
    x[at.R] = min(max(x[at.R], math.log(p.r_min)), math.log(1.25 * p.r_max))
    x[at.SHAPE] = min(max(x[at.SHAPE], -0.2), 1.6)
    for k in (FALLS, GROWS):
        x[k] = min(max(x[k], -0.5), 0.5)


@njit(error_model="numpy")
def descend(state, p, x, changed, steps, a, g):
    """Takes Gauss-Newton steps from x (15,), in place; no logarithm moves by more than 0.5 in one.

    Returns:
        Cost and mean squared residual at the last but one x, whose information is factored in `a` (15, 15).

    """
    cost, misfit = 0.0, 1.0
    for _ in range(steps):
        cost, misfit = _gather(state, p, x, a, g)
        cost += _add_priors(state, p, x, changed, a, g)
        if not factor(a):
            return math.inf, 1.0
        substitute(a, g)
        largest = max(abs(g[at.MU]), abs(g[at.R]), abs(g[at.SHAPE]), abs(g[at.RATIO]), 0.5)
        for j in range(STATES):
            x[j] += 0.5 / largest * g[j]
        _limit(p, x)
    return cost, misfit
