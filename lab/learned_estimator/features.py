"""The columns that the network of "gru" reads: one sample of a finger, and the samples just before it.

Sizes of vectors and angles between them only, so that the frame, its mirroring and the sign convention do not
matter. Training computes its columns with the same function.
"""

import math

from estimator._numba.caching import njit
from estimator.sample import LARGEST, norm
from estimator.stick_slip import halts, transition

LENGTH = 0.01
"""Length by which torque and spin are made comparable with force and speed [m]."""
TAPS = 6
"""Samples whose force is a column each, the newest first: a velocity may be as late."""
PAIRS = 1, 3
"""Ages of the forces that are combined with the newest velocity [samples]."""
COLUMNS = 2 * TAPS + 2 * len(PAIRS) + 13
"""Number of columns."""
OPEN = 0.6
"""Normal force up to which a sensor may be unloaded before the first contact [N]."""
STEADY = 0.25
"""Change of the normal force up to which a sensor without load stays without load [N]."""
SMALL_RATIO = 0.02
"""Added to a ratio of forces before its logarithm is taken [-]."""
SMALL_SPEED = 1e-4
"""Speed at which a direction means little [m/s]."""
SPEED = 1e-3
"""Unit of the speeds [m/s]."""
REACH = 100.0
"""Size that no column reaches with readings below `estimator.sample.LARGEST`: most are logarithms [-]."""


@njit(error_model="numpy")
def learn_zero(state, wrench):
    """Averages the readings before the first contact, which are the zero errors of the force sensor."""
    zero = state.zero
    if state.touched:
        return
    if abs(wrench[2]) >= OPEN or (state.unloaded > 0 and abs(wrench[2] - zero[2]) > STEADY):
        state.touched = True
        return
    state.unloaded += 1
    for k in range(4):
        zero[k] += (wrench[k] - zero[k]) / state.unloaded


@njit(error_model="numpy")
def _remember(state, ratio, lever):
    """Shifts the newest ratios into the taps; at the start of a contact all taps are the newest."""
    taps, logs = state.taps, state.logs
    first = TAPS - 1 if state.in_contact > 0 else 0
    newest = math.log(ratio + SMALL_RATIO), math.log(lever + SMALL_RATIO)
    for k in range(first, 0, -1):
        for j in range(2):
            taps[k, j], logs[k, j] = taps[k - 1, j], logs[k - 1, j]
    for k in range(1 if state.in_contact > 0 else TAPS):
        taps[k, 0], taps[k, 1] = ratio, lever
        logs[k, 0], logs[k, 1] = newest


@njit(error_model="numpy")
def _write(state, f_x, f_y, f_n, before, halted, twist, v_t, rim, x):
    """Writes the columns (COLUMNS,) of a sample in contact."""
    k = 0
    for tap in range(TAPS):
        x[k], x[k + 1] = state.logs[tap, 0], state.logs[tap, 1]
        k += 2
    for age in PAIRS:  # the solution for r and mu_c on an ellipsoid
        ratio, lever = state.taps[age, 0], state.taps[age, 1]
        square = (lever * v_t + 0.1 * SMALL_SPEED) / (ratio * rim + 0.1 * SMALL_SPEED)
        x[k] = 0.5 * math.log(square)
        x[k + 1] = 0.5 * math.log(ratio * ratio + lever * lever / square + SMALL_RATIO * SMALL_RATIO)
        k += 2
    speed = norm(v_t, rim)
    f_t = norm(f_x, f_y)
    x[k] = math.log(f_n)
    x[k + 1] = min(max((f_n - before) / f_n, -1.0), 1.0)
    x[k + 2] = halted
    x[k + 3] = math.asinh(v_t / SPEED)
    x[k + 4] = math.asinh(rim / SPEED)
    x[k + 5] = v_t / (speed + SMALL_SPEED)
    x[k + 6] = rim / (speed + SMALL_SPEED)
    x[k + 7] = abs(f_x * twist[0] + f_y * twist[1]) / (f_t * v_t + SMALL_SPEED)
    x[k + 8] = math.asinh((v_t - state.v_t) / SPEED)
    x[k + 9] = state.slipping
    x[k + 10] = math.log(1.0 + state.age)
    x[k + 11] = math.log(1.0 + state.in_contact)
    x[k + 12] = state.unloaded > 0


@njit(error_model="numpy")
def sense(state, p, wrench, twist, elapsed, x):
    """Takes a readable sample.

    Args:
        state: Record with the fields of `lab.learned_estimator.gru.STATE`; changed in place.
        p: Parameters.
        wrench: f_x, f_y, f_n, tau as read [N, N, N, N m].
        twist: v_x, v_y, omega [m/s, m/s, rad/s].
        elapsed: Time since the last sample [s].
        x: Output (COLUMNS,), written if the finger is in contact.

    Returns:
        Whether the finger is in contact, whether the heuristic halts, the normal force without its zero error
        [N], and the fractions of translation and of rotation [-].
    """
    learn_zero(state, wrench)
    zero = state.zero
    f_x, f_y, f_n = wrench[0] - zero[0], wrench[1] - zero[1], wrench[2] - zero[2]
    if not (state.touched and f_n >= p.eps_fn):
        state.halt_left, state.slipping, state.still_samples = 0.0, False, 0
        state.in_contact, state.age, state.v_t = 0, 0, 0.0
        return False, False, f_n, 0.0, 0.0
    before = state.f_n if state.in_contact > 0 else f_n
    halted = state.in_contact > 0 and halts(state, p, f_n, elapsed)
    v_t, rim = norm(twist[0], twist[1]), LENGTH * abs(twist[2])
    speed = norm(v_t, rim)
    ratio = min(norm(f_x, f_y) / f_n, LARGEST)
    lever = min(abs(wrench[3] - zero[3]) / (LENGTH * f_n), LARGEST)
    starts, stops = transition(state, p, speed <= p.stick_band, speed > p.eps_v)
    state.age = 0 if starts or stops else state.age + 1
    if starts or stops:
        state.events_mu_s += 1
    _remember(state, ratio, lever)
    _write(state, f_x, f_y, f_n, before, halted, twist, v_t, rim, x)
    state.in_contact += 1
    state.v_t = v_t
    across, turn = (v_t, rim) if state.slipping else (ratio, lever)
    size = norm(across, turn)
    if 0.0 < size < math.inf:
        return True, halted, f_n, across / size, turn / size
    return True, halted, f_n, 0.0, 0.0
