"""Functions that the compiled kernels of all estimators call.

Source: Waltersson & Karayiannidis, Friction Estimation for In-Hand Planar Motion (ISER 2025): Algorithm 1 for
mu_s and the heuristic. `state` is a record whose dtype holds STICK_SLIP_STATE, `p` one of a subclass of
StickSlipParameters.
"""

import math

from numba import njit

SCATTER_GAIN = 0.2
"""Weight of a new event in the scatter of mu_s, once 1 / SCATTER_GAIN changes have been averaged."""


@njit
def norm(x, y):
    """Length of (x, y); quicker than hypot, whose care for overflow is not needed here."""
    return math.sqrt(x * x + y * y)


@njit(error_model="numpy")
def shares(translation, rotation):
    """Direction cosines of (translation, rotation); zeros where there is none."""
    scale = 1.0 / norm(translation, rotation)
    if 0.0 < scale < math.inf:
        return min(translation * scale, 1.0), min(rotation * scale, 1.0)
    return 0.0, 0.0


@njit
def clamped(value, low, high):
    """The value, or the bound that it exceeds."""
    return min(max(value, low), high)


@njit
def halts(state, p, f_n, elapsed):
    """Heuristic: a rise of f_n faster than eps_delta halts for halt_duration; each new one starts it afresh.

    The sample at which exactly halt_duration has passed learns again; half a sample of tolerance makes that
    hold for times that carry rounding or jitter.
    """
    if not p.heuristic or state.samples == 0:
        return False
    state.halt_left = max(state.halt_left - elapsed, 0.0)
    if (f_n - state.f_n) / elapsed > p.eps_delta:
        state.halt_left = p.halt_duration - 0.5 * p.sample_time
    return state.halt_left > 0.0


@njit
def clear_buffer(state):
    """Forgets the buffered force ratios."""
    state.buffer_size = 0
    state.buffer_next = 0


@njit
def append(state, p, ratio):
    """Buffers a force ratio in place of the oldest of n_b."""
    state.buffer[state.buffer_next] = ratio
    state.buffer_next = state.buffer_next + 1 if state.buffer_next + 1 < p.n_b else 0
    state.buffer_size = min(state.buffer_size + 1, p.n_b)


@njit
def take_event(state, p):
    """Mean of the n_a largest buffered ratios, within bounds; takes each out by writing -1 over it."""
    total = 0.0
    for _ in range(p.n_a):
        largest = 0
        for i in range(state.buffer_size):
            if state.buffer[i] > state.buffer[largest]:
                largest = i
        total += state.buffer[largest]
        state.buffer[largest] = -1.0  # below every ratio
    return clamped(total / p.n_a, p.mu_min, p.mu_max)


@njit
def transition(state, p, still, moves):
    """Runs the stick-slip machine by one sample.

    Args:
        state: Changed in place.
        p: Parameters.
        still: Whether the speed is within stick_band.
        moves: Whether it is above eps_v.

    Returns:
        Whether a slip starts, and whether one stops, at this sample.
    """
    state.still_samples = state.still_samples + 1 if still else 0
    starts = moves and not state.slipping
    stops = state.slipping and state.still_samples >= p.stick_samples
    if starts or stops:
        state.slipping = starts
    return starts, stops


@njit
def learn_mu_s(state, value, gain, jumps):
    """mu_s goes by `gain` towards an event's value.

    Its standard deviation comes from the scatter of independent events, averaged with the gain: a change has
    the variance of one event and of the average before it. One that `jumps` says nothing of it. Up to the
    first change mu_s stands for itself: nothing is known.
    """
    if state.events_mu_s > 0 and not jumps:
        state.changes_mu_s += 1
        share = max(1.0 / state.changes_mu_s, SCATTER_GAIN)
        square = (value - state.mu_s) ** 2 / (1.0 + state.gain_mu_s)
        state.scatter_mu_s = (1.0 - share) * state.scatter_mu_s + share * square
    state.mu_s = (1.0 - gain) * state.mu_s + gain * value
    state.gain_mu_s = gain
    state.events_mu_s += 1
    state.confidence_mu_s = state.events_mu_s / (state.events_mu_s + 1.0)
    state.sd_mu_s = math.sqrt(gain * state.scatter_mu_s) if state.changes_mu_s > 0 else state.mu_s


@njit
def count_mu_c(state, p):
    """Notes an update of mu_c: the share of its memory that data fill grows to 1 - forgetting**updates."""
    state.updates_mu_c += 1
    state.confidence_mu_c += (1.0 - p.forgetting) * (1.0 - state.confidence_mu_c)


@njit
def count_r(state, p):
    """Notes an update of r, like `count_mu_c`."""
    state.updates_r += 1
    state.confidence_r += (1.0 - p.forgetting) * (1.0 - state.confidence_r)


@njit
def lose_contact(state):
    """Ends a halt and a slip, and empties the buffer."""
    state.halt_left = 0.0
    state.slipping = False
    state.still_samples = 0
    clear_buffer(state)


@njit
def readable(state, t, f_t, f_n, tau, speed):
    """Whether a sample is finite and later than the last one."""
    finite = math.isfinite(f_t) and math.isfinite(f_n) and math.isfinite(tau) and math.isfinite(speed)
    return finite and math.isfinite(t) and (state.samples == 0 or t - state.t > 0.0)


@njit
def publish(state, t, f_n, gamma_t, gamma_tau, halted, saw_mu_c, saw_r, estimate):
    """Closes a sample: remembers t [s] and f_n [N], writes the ESTIMATE record."""
    state.t = t
    state.f_n = f_n
    state.samples += 1
    estimate.mu_s = state.mu_s
    estimate.mu_c = state.mu_c
    estimate.r = state.r
    estimate.gamma_t = gamma_t
    estimate.gamma_tau = gamma_tau
    estimate.confidence_mu_s = state.confidence_mu_s
    estimate.confidence_mu_c = state.confidence_mu_c
    estimate.confidence_r = state.confidence_r
    estimate.events_mu_s = state.events_mu_s
    estimate.updates_mu_c = state.updates_mu_c
    estimate.updates_r = state.updates_r
    estimate.slipping = state.slipping
    estimate.halted = halted
    estimate.sd_mu_s = state.sd_mu_s
    estimate.sd_mu_c = state.sd_mu_c
    estimate.sd_r = state.sd_r
    estimate.observable_mu_c = saw_mu_c
    estimate.observable_r = saw_r
