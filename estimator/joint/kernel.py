"""The compiled update of the "joint" estimator, and of any other that differs in its limit surface."""

from numba import njit

from estimator.compiled import entry_point
from estimator.joint.memory import sd_mu_c, sd_r
from estimator.joint.parameters import JointParameters
from estimator.joint.solution import learn
from estimator.joint.state import STATE
from estimator.joint.timing import boundary, reference_speed
from estimator.limit_surface.shape import ELLIPSOID, wrench_shape
from estimator.stick_slip.kernel import (
    append,
    clear_buffer,
    halts,
    learn_mu_s,
    length,
    lose_contact,
    publish,
    readable,
    sd_mu_s,
    shares,
    transition,
)


@njit
def learn_static(state, p, surface, f_t, f_n, tau, speed, halted):
    """mu_s at each start of a slip: the largest mu of the stick before it whose surface the wrench is on."""
    if not halted and not state.slipping:
        gamma_t, _ = shares(f_t, tau / state.r)
        if gamma_t > p.eps_t:
            append(state, p, f_t / (gamma_t * f_n * wrench_shape(surface, gamma_t * gamma_t)))
    starts, stops = transition(state, p, speed)
    if starts and not halted:
        learn_mu_s(state, p, max(1.0 / (state.events_mu_s + 1.0), p.gain_mu_s))
    if starts or stops:
        clear_buffer(state)


@njit
def update(state, p, surface, t, wrench, twist, estimate):
    """One finger, one sample.

    Args:
        state: STATE record, changed in place.
        p: JointParameters record.
        surface: ELLIPSOID or DISC.
        t: Time [s].
        wrench: (4,) f_x, f_y, f_n, tau [N, N, N, N m].
        twist: (3,) v_x, v_y, omega [m/s, m/s, rad/s].
        estimate: ESTIMATE record, written.
    """
    f_t = length(wrench[0], wrench[1])
    f_n = wrench[2]
    tau = abs(wrench[3])
    speed = reference_speed(p, twist)
    if not readable(state, t, f_t, f_n, tau, speed):
        return

    halted, saw_mu_c, saw_r = False, False, False
    gamma_t, gamma_tau = 0.0, 0.0
    elapsed = t - state.t
    if f_n >= p.eps_fn:
        moves = speed > p.eps_v
        halted = halts(state, p, f_n, elapsed)
        slid, f_t_then, f_n_then, tau_then, v_t_then, omega_then = boundary(
            state, p, f_t, f_n, tau, twist, moves, elapsed
        )
        if slid and not halted:
            saw_mu_c, saw_r = learn(state, p, surface, f_t_then, f_n_then, tau_then, v_t_then, omega_then)
        learn_static(state, p, surface, f_t, f_n, tau, speed, halted)
        if moves:
            gamma_t, gamma_tau = shares(length(twist[0], twist[1]), state.r * abs(twist[2]))
        else:
            gamma_t, gamma_tau = shares(f_t, tau / state.r)
    else:
        lose_contact(state)
        state.in_a_row = 0
    state.elapsed = elapsed
    publish(state, p, t, f_n, gamma_t, gamma_tau, halted, estimate)
    estimate.sd_mu_s = sd_mu_s(state, max(1.0 / max(state.events_mu_s, 1), p.gain_mu_s))
    estimate.sd_mu_c = sd_mu_c(state, p)
    estimate.sd_r = sd_r(state, estimate.sd_mu_c)
    estimate.observable_mu_c = saw_mu_c
    estimate.observable_r = saw_r


@entry_point(STATE, JointParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Update n fingers by one sample each, on the ellipsoid.

    A row with a value that is not finite, or with a t not later than the row's last, is left as it is.

    Args:
        states: (n,) of dtype STATE, changed in place.
        parameters: (1,), shared, or (n,) of dtype JointParameters.dtype().
        t: Time [s].
        wrenches: (n, 4) f_x, f_y, f_n, tau [N, N, N, N m] at the CoP.
        twists: (n, 3) v_x, v_y, omega [m/s, m/s, rad/s] at the CoP.
        estimates: (n,) of dtype ESTIMATE, written.
    """
    for i in range(len(states)):
        p = parameters[i % len(parameters)]
        update(states[i], p, ELLIPSOID, t, wrenches[i], twists[i], estimates[i])
