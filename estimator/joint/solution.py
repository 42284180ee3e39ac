"""mu_c and r in closed form from one instant of sliding.

On the ellipsoid of Waltersson & Karayiannidis (ISER 2025), eqs. (1) f_t = gamma_t f_n mu_c and
(2) tau = gamma_tau mu_c f_n r have the ratio tau / f_t = r^2 omega / v_t, so

    r = sqrt(tau v_t / (f_t omega)),
    mu_c = sqrt(f_t^2 + (tau / r)^2) / f_n = sqrt(f_t (f_t + tau omega / v_t)) / f_n.

Another limit surface corrects both by factors of the share that translation has in the power:
`estimator.limit_surface.shape`. No estimate enters, neither in the equations nor in their gates: nothing can
be locked out.
"""

import math

from numba import njit

from estimator.joint.memory import learn_mu_c, learn_product, learn_r, r_of_product
from estimator.limit_surface.shape import pivot_factor, power_shape, viscous_arm
from estimator.stick_slip.kernel import length


@njit
def _square(x):
    return x * x


@njit(error_model="numpy")  # what overflows is refused where it would be learnt
def _friction(state, p, surface, f_t, f_n, tau, v_t, omega):
    """mu_c from the power that friction takes; the centre of rotation may be anywhere."""
    total = f_t + tau * omega / v_t
    share = f_t / total
    inverse_u, u_by_w, slope = power_shape(surface, share)
    y = math.sqrt(f_t * total) / f_n * inverse_u
    power = 0.5 + slope
    k = power * (1.0 - share)  # dln mu_c = (1 - k) dln f_t + k dln(tau omega / v_t)
    relative = (
        _square(p.law_error)
        + _square((1.0 - k) * p.sd_force / f_t)
        + _square(p.sd_normal / f_n)
        + _square(k * p.sd_speed / v_t)
        + (_square(omega * p.sd_torque) + _square(tau * p.sd_spin)) * _square(power / (v_t * total))
    )
    # to first order a viscosity sigma adds (1 - k) sigma v_t / F + k sigma (lever arm)^2 omega / (r T)
    v = v_t / math.sqrt(share) * inverse_u * (1.0 + k * (viscous_arm(surface) * _square(u_by_w) - 1.0))
    return learn_mu_c(state, p, y, _square(y) * relative, v)


@njit(error_model="numpy")  # what overflows is refused where it would be learnt
def _radius(state, p, surface, f_t, tau, v_t, omega):
    """Radius where slide and spin are both seen."""
    _, u_by_w, slope = power_shape(surface, f_t / (f_t + tau * omega / v_t))
    y = math.sqrt(tau * v_t / (f_t * omega)) * u_by_w
    relative = (
        _square(0.5 - slope) * (_square(p.sd_torque / tau) + _square(p.sd_force / f_t))
        + _square(0.5 + slope) * (_square(p.sd_speed / v_t) + _square(p.sd_spin / omega))
        + _square(p.law_error)
    )
    return learn_r(state, p, y, _square(y) * relative, 0.0)


@njit(error_model="numpy")  # what overflows is refused where it would be learnt
def _spin(state, p, surface, f_n, tau, v_t, omega):
    """Where only the spin is seen: r if mu_c is known, else the product of both."""
    arm = tau / f_n
    relative = _square(p.sd_torque / tau) + _square(p.sd_normal / f_n) + _square(p.law_error)
    if state.updates_mu_c == 0:
        learn_product(state, p, arm, _square(arm) * relative)
        return False
    friction = max(state.mu_c + state.viscosity * viscous_arm(surface) * state.r * omega, p.mu_min)
    arm /= friction
    pivot = pivot_factor(surface) * v_t / omega
    y = math.sqrt(0.5 * arm * (arm + length(arm, 2.0 * pivot)))  # tau = mu_c f_n r T(r)
    return learn_r(state, p, y, _square(y) * relative, 1.0)


@njit
def learn(state, p, surface, f_t, f_n, tau, v_t, omega):
    """Learns from one instant of sliding what stands above its noise.

    Args:
        state: STATE record, changed in place.
        p: JointParameters record.
        surface: ELLIPSOID or DISC.
        f_t: Tangential force [N].
        f_n: Normal force [N].
        tau: Magnitude of the torque [N m].
        v_t: Speed of translation [m/s].
        omega: Magnitude of the spin [rad/s].

    Returns:
        Whether mu_c, and whether r, was learnt.
    """
    gate = p.noise_gate
    slide = f_t > gate * p.sd_force and v_t > gate * p.sd_speed
    spin = tau > gate * p.sd_torque and omega > gate * p.sd_spin
    if not slide:
        return False, spin and _spin(state, p, surface, f_n, tau, v_t, omega)
    saw_mu_c = _friction(state, p, surface, f_t, f_n, tau, v_t, omega)
    if spin and v_t < p.pivot_limit * p.r_max * omega:
        return saw_mu_c, _radius(state, p, surface, f_t, tau, v_t, omega)
    return saw_mu_c, saw_mu_c and r_of_product(state, p)
