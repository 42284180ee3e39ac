"""Computes residuals: a stretch of slip against the friction law, a load at the limit of stick against mu.

With u the velocity at the centre of pressure, w = r omega, theta = atan2(|w|, |u|) and S the limit surface,

    f_t = f_n (mu S_t(theta) + sigma_2 |u|),    tau = f_n r (mu S_tau(theta) + sigma_2 |w|) sign(omega),
    mu = mu_c (1 + (mu_s / mu_c - 1) exp(-(v / v_s)^2)),    v^2 = u^2 + w^2

(Waltersson & Karayiannidis, Planar friction modelling with LuGre dynamics and limit surfaces, arXiv
2308.01123). The sensor adds zero errors and the tilt times f_n, and takes the torque about the assumed
centre.

On the limit surface the size of the load over f_n is mu_s before the break-away, and mu_c after the fall of
the force. Only the size is compared: the velocity, which is late, does not matter.
"""

import math

from estimator._numba.caching import njit
from estimator.window import layout as at
from estimator.window.layout import EVENT, SHORTEST
from estimator.window.surface import surface


@njit(error_model="numpy")
def slide(x, s, p, sign, old, e, h, var):
    """Residual of an entry, its derivatives by the states, and its variances.

    Args:
        x: States (15,).
        s: Entry of the kind SLIDE.
        p: Parameters.
        sign: 1 if the wrench is that on the finger, else -1.
        old: Whether the entry is older than the newest change.
        e: Output (3,): force along the motion and across it [N], torque [N m].
        h: Output (3, 15): derivatives of the expected values.
        var: Output (3,) [N^2, N^2, N^2 m^2].
    """
    omega, f_n, load = s.motion[2], s.wrench[2], s.load
    u, v = s.motion[0] - omega * x[at.COP + 1], s.motion[1] + omega * x[at.COP]
    v_t = math.sqrt(u * u + v * v) + 1e-9
    u_x, u_y = u / v_t, v / v_t
    r = math.exp(x[at.R] + x[at.GROWS] * load)
    w, turn = r * abs(omega), 1.0 if omega >= 0.0 else -1.0
    square = v_t * v_t + w * w
    s_t, s_r, by_t, by_r, shape_t, shape_r = surface(x[at.SHAPE], math.atan2(w, v_t))
    ratio = math.exp(x[at.RATIO])
    level = 1.0 + (ratio - 1.0) * s.slow
    k = f_n * level * math.exp(x[at.MU] - x[at.FALLS] * load + (x[at.OLD] if old else 0.0))
    f_t = k * s_t + f_n * x[at.SIGMA] * v_t
    tau = turn * r * (k * s_r + f_n * x[at.SIGMA] * w)
    arm = x[at.COP] * u_y - x[at.COP + 1] * u_x
    f_x = s.wrench[0] - x[at.ZERO] - f_n * x[at.TILT]
    f_y = s.wrench[1] - x[at.ZERO + 1] - f_n * x[at.TILT + 1]
    e[0] = f_x * u_x + f_y * u_y - sign * f_t
    e[1] = f_y * u_x - f_x * u_y
    e[2] = s.wrench[3] - x[at.TORQUE] - sign * (tau + arm * f_t)

    for i in range(3):
        for j in range(at.STATES):
            h[i, j] = 0.0
    a, b = sign * k * s_t, sign * turn * r * k * s_r
    h[0, at.MU], h[2, at.MU] = a, b + arm * a
    h[0, at.FALLS], h[2, at.FALLS] = -load * h[0, at.MU], -load * h[2, at.MU]
    part = ratio * s.slow / level
    h[0, at.RATIO], h[2, at.RATIO] = part * h[0, at.MU], part * h[2, at.MU]
    turned = v_t * w / square  # d theta / d ln r
    a = sign * k * by_t * turned
    b = sign * (tau + turn * r * (k * by_r * turned + f_n * x[at.SIGMA] * w))
    h[0, at.R], h[2, at.R] = a, b + arm * a
    h[0, at.GROWS], h[2, at.GROWS] = load * h[0, at.R], load * h[2, at.R]
    if old:
        h[0, at.OLD], h[2, at.OLD] = h[0, at.MU], h[2, at.MU]
    a, b = sign * k * shape_t, sign * turn * r * k * shape_r
    h[0, at.SHAPE], h[2, at.SHAPE] = a, b + arm * a
    a, b = sign * f_n * v_t, sign * turn * r * f_n * w
    h[0, at.SIGMA], h[2, at.SIGMA] = a, b + arm * a
    h[0, at.ZERO], h[0, at.ZERO + 1], h[1, at.ZERO], h[1, at.ZERO + 1] = u_x, u_y, -u_y, u_x
    h[0, at.TILT], h[0, at.TILT + 1] = f_n * u_x, f_n * u_y
    h[1, at.TILT], h[1, at.TILT + 1] = -f_n * u_y, f_n * u_x
    h[2, at.TORQUE] = 1.0
    force_v = k * by_t * (-w / square) + f_n * x[at.SIGMA]
    torque_v, off_arm = turn * r * k * by_r * (-w / square), x[at.COP] * u_x + x[at.COP + 1] * u_y
    for j in range(2):
        du, dv, direct = (0.0, omega, u_y) if j == 0 else (-omega, 0.0, -u_x)
        along, across = u_x * du + u_y * dv, (u_x * dv - u_y * du) / v_t
        h[0, at.COP + j] = sign * force_v * along
        h[1, at.COP + j] = sign * f_t * across
        h[2, at.COP + j] = sign * ((torque_v + arm * force_v) * along + (direct + off_arm * across) * f_t)

    size = f_t * f_t + (tau / r) ** 2
    off = p.law_error * p.law_error * (1.0 + 6.0 * (SHORTEST / s.time) ** 2) * size  # both ends are off, too
    angle, unsteady = s.var_speed / square, s.var_speed / (v_t * v_t + s.var_speed)
    force = (s.noise + 0.16) * p.sd_force * p.sd_force
    var[0] = force + off + (k * by_t) ** 2 * angle + (unsteady * f_t) ** 2
    # anisotropy of 5 % changes the size of a load by up to 2.5 %, and turns it by up to 5
    var[1] = force + 4.0 * off + unsteady * f_t * f_t
    var[2] = s.noise * p.sd_torque * p.sd_torque + r * r * (off + (k * by_r) ** 2 * angle)


@njit(error_model="numpy")
def stick(x, s, p, old, of_r, e, h, var):
    """Residual of ln (load / f_n), derivatives and variance, in the first row of the outputs of `slide`.

    The load before a slip says what mu_s is, not what mu_c is: one that is wrong must not pull the other.
    `of_r`: variance of ln r, by which the size of a torque is uncertain then.
    """
    f_n = s.wrench[2]
    f_x = s.wrench[0] - x[at.ZERO] - f_n * x[at.TILT]
    f_y = s.wrench[1] - x[at.ZERO + 1] - f_n * x[at.TILT + 1]
    tau = s.wrench[3] - x[at.TORQUE] - x[at.COP] * f_y + x[at.COP + 1] * f_x
    r = math.exp(x[at.R] + x[at.GROWS] * s.load)
    rim = (tau / r) ** 2
    square = f_x * f_x + f_y * f_y + rim + 1e-9
    share = rim / square
    expected = x[at.MU] - x[at.FALLS] * s.load + (x[at.OLD] if old else 0.0)
    expected += s.slow * x[at.RATIO]
    e[0] = 0.5 * math.log(square) - math.log(f_n) - expected
    for j in range(at.STATES):
        h[0, j] = 0.0
    var[0] = EVENT * EVENT + (p.sd_force * p.sd_force + share * (p.sd_torque / r) ** 2) / square
    if s.kind == at.BREAK:
        h[0, at.RATIO] = 1.0
        var[0] += share * share * of_r
    else:
        h[0, at.MU], h[0, at.FALLS], h[0, at.R] = 1.0, -s.load, share
        var[0] += (s.slow * p.sd_log_ratio) ** 2
        if old:
            h[0, at.OLD] = 1.0
        for j in range(2):
            f = f_x if j == 0 else f_y
            h[0, at.ZERO + j], h[0, at.TILT + j] = f / square, f_n * f / square
