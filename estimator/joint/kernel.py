"""The compiled update of "joint" and "disc": mu_c and r from each sample of sliding, at once.

The limit surface gives two equations, f_t and tau, for both unknowns. Their ratio with the twist,
q = tau omega / (f_t v_t), tells where on the surface the slip is, whatever mu_c and r; on the ellipsoid of
Waltersson & Karayiannidis (ISER 2025), eqs. (1) and (2), in closed form

    r = sqrt(q) v_t / omega = sqrt(tau v_t / (f_t omega)),    mu_c = sqrt(1 + q) f_t / f_n,

on a uniform disc with tabulated factors (`estimator.limit_surface.inverse`). No estimate enters, neither in
the equations nor in their gates: nothing can be locked out.
"""

import math

from numba import njit

from estimator.compiled import entry_point
from estimator.joint.memory import learn_mu_c, learn_r, sd_mu_c
from estimator.joint.parameters import JointParameters
from estimator.joint.state import STATE
from estimator.limit_surface.inverse import slip_radius, slip_share, spin_radius
from estimator.sliding.update import close_sample, open_sample
from estimator.stick_slip.kernel import norm


@njit
def _square(x):
    return x * x


@njit(error_model="numpy")  # what overflows is refused where it would be learnt
def _friction(state, p, f_t, f_n, tau, v_t, omega):
    """mu_c where a slide is seen; the centre of rotation may be anywhere."""
    rate = omega / (f_t * v_t)  # q over tau
    q = tau * rate
    share, slope = slip_share(p.disc, q)
    y = f_t / (f_n * share)
    noise = (
        _square((1.0 - slope * q) * p.sd_force / f_t)
        + _square(p.sd_normal / f_n)
        + _square(slope * rate * p.sd_torque)
        + _square(slope * tau / (f_t * v_t) * p.sd_spin)
        + _square(slope * q * p.sd_speed / v_t)
    )
    return learn_mu_c(state, p, y, noise, v_t / share)


@njit(error_model="numpy")  # what overflows is refused where it would be learnt
def _radius(state, p, f_t, tau, v_t, omega):
    """Radius where slide and spin are both seen."""
    y, sensitivity = slip_radius(p.disc, tau * omega / (f_t * v_t), v_t / omega)
    of_q = _square(p.sd_torque / tau) + _square(p.sd_force / f_t)
    twist = _square((1.0 - sensitivity) * p.sd_speed / v_t) + _square((1.0 - sensitivity) * p.sd_spin / omega)
    return learn_r(state, p, y, _square(sensitivity) * of_q + twist)


@njit(error_model="numpy")  # what overflows is refused where it would be learnt
def _radius_of_spin(state, p, f_n, tau, v_t, omega):
    """Radius where only the spin is seen: from tau, with the mu_c known."""
    friction = max(state.mu_c + state.viscosity * norm(v_t, state.r * omega), p.mu_min)
    y = spin_radius(p.disc, tau / (friction * f_n), v_t / omega)
    noise = _square(p.sd_torque / tau) + _square(p.sd_normal / f_n) + _square(sd_mu_c(state, p) / friction)
    return learn_r(state, p, y, noise)


@njit
def _motion(state, p, f_t, f_n, tau, v_t, omega):
    """Learns from one instant of sliding what stands above its noise.

    Returns:
        Whether mu_c, and whether r, was learnt.
    """
    gate = p.noise_gate
    slide = f_t > gate * p.sd_force and v_t > gate * p.sd_speed
    spin = tau > gate * p.sd_torque and omega > gate * p.sd_spin
    saw_mu_c = slide and _friction(state, p, f_t, f_n, tau, v_t, omega)
    if slide and spin and v_t < p.pivot_limit * p.r_max * omega:
        return saw_mu_c, _radius(state, p, f_t, tau, v_t, omega)
    if spin and not slide and state.updates_mu_c > 0:
        return saw_mu_c, _radius_of_spin(state, p, f_n, tau, v_t, omega)
    return saw_mu_c, False


@njit
def _update(state, p, t, wrench, twist, estimate):
    """One finger, one sample."""
    taken, halted, slid, instant, seen = open_sample(state, p, t, wrench, twist)
    if taken:
        saw_mu_c, saw_r = _motion(state, p, *instant) if slid else (False, False)
        close_sample(state, p, t, seen, halted, saw_mu_c, saw_r, estimate)
        estimate.sd_mu_c = sd_mu_c(state, p) if state.updates_mu_c > 0 else state.mu_c
        estimate.sd_r = math.sqrt(state.noise_r) / state.information_r if state.updates_r > 0 else state.r


@entry_point(STATE, JointParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Update n fingers by one sample each.

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
        _update(states[i], parameters[i % len(parameters)], t, wrenches[i], twists[i], estimates[i])
