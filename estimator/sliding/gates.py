"""Whether a slide or a spin stands above the sensors' noise."""

from numba import njit


@njit
def slides(p, f_t, v_t):
    """Whether f_t [N] and v_t [m/s] both do."""
    return f_t > p.noise_gate * p.sd_force and v_t > p.noise_gate * p.sd_speed


@njit
def spins(p, tau, omega):
    """Whether |tau| [N m] and |omega| [rad/s] both do."""
    return tau > p.noise_gate * p.sd_torque and omega > p.noise_gate * p.sd_spin
