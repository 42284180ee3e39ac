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
from estimator.joint.memory import learn_mu_c, learn_r, priors
from estimator.joint.parameters import JointParameters
from estimator.joint.state import STATE
from estimator.limit_surface.inverse import slip_factors, spin_radius
from estimator.sliding.gates import slides, spins
from estimator.sliding.update import close_sample, open_sample
from estimator.stick_slip.kernel import norm


@njit
def _square(x):
    return x * x


@njit
def _slide(state, p, prior, instant, near):
    """mu_c where a slide is seen, and r where a spin is seen with it and `near`.

    With c = d ln mu_c / d ln(1 + q) and a = c q / (1 + q), ln mu_c has the derivatives 1 - a by ln f_t, a by
    ln tau and ln omega, -a by ln v_t, -1 by ln f_n; with b = d ln r / d ln q, ln r has b by ln tau, -b by
    ln f_t, 1 - b by ln v_t, b - 1 by ln omega.
    """
    f_t, f_n, tau, v_t, omega, of_speed, of_spin = instant
    per_f, per_v, per_n = 1.0 / f_t, 1.0 / v_t, 1.0 / f_n
    per_power = per_f * per_v
    q = tau * omega * per_power
    if not q < math.inf:
        return False, False
    s = 1.0 / (1.0 + q)
    friction, c, radius, b = slip_factors(p.disc, s)
    a, size = c * (1.0 - s), friction * math.sqrt(1.0 + q)
    of_force, of_speed = _square(p.sd_force * per_f), of_speed * _square(per_v)
    noise = (
        _square(1.0 - a) * of_force
        + _square(a) * of_speed
        + _square(p.sd_normal * per_n)
        + _square(c * s * per_power) * (_square(omega * p.sd_torque) + _square(tau) * of_spin)
    )
    saw_mu_c = learn_mu_c(state, p, prior, f_t * per_n * size, noise, v_t * size)
    if not near:
        return saw_mu_c, False
    per_omega = 1.0 / omega
    noise = _square(b) * (of_force + _square(p.sd_torque / tau)) + _square(1.0 - b) * (
        of_speed + of_spin * _square(per_omega)
    )
    return saw_mu_c, learn_r(state, p, prior, radius * math.sqrt(q) * v_t * per_omega, noise)


@njit
def _spin(state, p, prior, instant):
    """R where only the spin is seen: from tau, with the mu_c known."""
    _, f_n, tau, v_t, omega, _, _ = instant
    friction = max(state.mu_c + state.viscosity * norm(v_t, state.r * omega), p.mu_min)
    y = spin_radius(p.disc, tau / (friction * f_n), v_t / omega)
    noise = _square(p.sd_torque / tau) + _square(p.sd_normal / f_n) + _square(state.sd_mu_c / friction)
    return learn_r(state, p, prior, y, noise)


@njit
def _motion(state, p, prior, instant):
    """Learns from one instant of sliding what stands above its noise.

    Returns:
        Whether mu_c, and whether r, was learnt.
    """
    f_t, _, tau, v_t, omega, _, _ = instant
    spin = spins(p, tau, omega)
    if slides(p, f_t, v_t):
        return _slide(state, p, prior, instant, spin and v_t < p.pivot_limit * p.r_max * omega)
    return False, spin and state.updates_mu_c > 0 and _spin(state, p, prior, instant)


@njit
def _update(state, p, prior, t, wrench, twist, estimate):
    """One finger, one sample."""
    taken, halted, slid, instant, seen = open_sample(state, p, t, wrench, twist)
    if taken:
        saw_mu_c, saw_r = _motion(state, p, prior, instant) if slid else (False, False)
        close_sample(state, p, t, seen, halted, saw_mu_c, saw_r, estimate)


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
    p = parameters[0]
    prior = priors(p)
    for i in range(len(states)):
        if 0 < i < len(parameters):
            p = parameters[i]
            prior = priors(p)
        wrench = wrenches[i, 0], wrenches[i, 1], wrenches[i, 2], wrenches[i, 3]
        twist = twists[i, 0], twists[i, 1], twists[i, 2]
        _update(states[i], p, prior, t, wrench, twist, estimates[i])
