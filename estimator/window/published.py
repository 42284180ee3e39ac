"""Publishes what the fit says: values at the present normal force, deviations, confidence.

The covariance of the fit, times its reduced chi square, contains every state that the motion does not show.
Added are the errors that no motion shows: gain, cross-talk and anisotropy (`sd_gain`), the zero error of f_n,
and slips that were none.
"""

import math

from estimator._numba.caching import njit
from estimator.estimate import confidence_of
from estimator.sample import clamped
from estimator.window.layout import MU, RATIO, R
from estimator.window.window import refer

NEARLY = 0.02  # Relative change of the normal force for which the values are computed again
LATER, AGEING = 1.0, 1e-3
"""Time after which they are computed again [s]; variance of ln mu_c that a second without slips adds."""
EVENTS = 0.05  # Relative error that all break-aways share: the time in stick, the place


SPRUNG = 0.6  # Relative error of a slip that was a spring of the pad: its load is anywhere up to the limit


confidence = njit(confidence_of, error_model="numpy")


@njit(error_model="numpy")
def publish_fit(state, p, f_n):
    """Writes the values of the state at a normal force [N], if they have changed since."""
    if state.fitted:
        state.fit_time = state.t
    again = abs(f_n - state.load) > NEARLY * state.load or state.t > state.look_time + LATER
    if not (state.fitted or again) or state.updates_mu_c == 0:
        return
    refer(state, f_n)
    state.fitted, state.load, state.look_time = False, f_n, state.t
    x, c = state.x, state.covariance
    hidden = p.sd_gain * p.sd_gain + state.variance_normal / (f_n * f_n) + AGEING * (state.t - state.fit_time)
    sprung = SPRUNG * SPRUNG * state.springs
    hidden += sprung
    square = c[MU, MU] + hidden
    state.mu_c = clamped(math.exp(x[MU]), p.mu_min, p.mu_max)
    state.sd_mu_c, state.confidence_mu_c = state.mu_c * math.sqrt(square), confidence(square)
    if state.updates_r > 0:
        state.at_bound = 1.0 if math.exp(x[R]) > p.r_max else 0.0
        state.r = clamped(math.exp(x[R]), p.r_min, p.r_max)
        # an r beyond the pad follows a torque that is not that of a slip
        square = c[R, R] + p.sd_gain * p.sd_gain + sprung + state.at_bound * p.sd_log_r0 * p.sd_log_r0
        state.sd_r, state.confidence_r = state.r * math.sqrt(square), confidence(square)
    square = max(c[MU, MU] + c[R, R] + 2.0 * c[MU, R], 0.0) + hidden
    state.sd_lever = state.mu_c * state.r * math.sqrt(square)
    # where break-aways are known, they say what mu_s is, whatever mu_c is
    left = min(c[RATIO, RATIO] / state.variance[RATIO], 1.0)
    square = c[RATIO, RATIO] + left * left * c[MU, MU] + hidden + EVENTS * EVENTS
    state.mu_s = clamped(math.exp(x[MU] + x[RATIO]), p.mu_min, p.mu_max)
    state.sd_mu_s = state.mu_s * math.sqrt(square)
    state.confidence_mu_s = confidence(square) if state.events_mu_s > 0 else 0.0
