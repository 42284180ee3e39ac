"""The friction step of a patch: an elasto-plastic return mapping in every cell.

Cell i lies at x_i from the centre of pressure and carries the share w_i of the normal
force f_n (LuGre patch of Waltersson & Karayiannidis, arXiv 2308.01123):

    v_i = v + omega x x_i                              slip velocity of the cell
    g_i = mu_c + (mu_s - mu_c) exp(-(s_i / v_s)^gamma)
    f_i = w_i f_n (sigma_0 z_i + sigma_1 dz_i/dt + sigma_2 v_i),    |z_i| <= g_i / sigma_0
    F = -sum f_i,    tau = -sum x_i x f_i

A step h is the ellipsoid's (`slipgym.contact.kernel`), in two dimensions: z_i is brought
into the ball if g_i has fallen, which is loss and not dz_i/dt; then v_i h is added and the
result projected onto the ball. Hence it truly sticks, takes at least the energy that it
stores whatever the twist, and has no limit sigma_0 |v| h / g < 1. Steady slip is LuGre's:
z_i = g_i v_i / (sigma_0 |v_i|), in which it arrives along the shortest way and not
exponentially. The exponential step of LuGre has no limit either; but it drifts in stick
or needs a switching function, and passivity would rest on that function.

The twist is prescribed, so the slip speed to come is known and not extrapolated: s_i is
|v_i| in slip. In stick it only falls (elastic motion must not lower g), which one number a
cell keeps: the cap, infinite in slip.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from slipgym.compiled import compiled


class Law(NamedTuple):
    """Friction law of all cells."""

    mu_c: float
    """Coulomb friction [-]."""
    mu_s: float
    """Static friction [-]."""
    stribeck_velocity: float
    """v_s [m/s]."""
    stribeck_exponent: float
    """gamma [-]."""
    sigma_0: float
    """Bristle stiffness per normal force [1/m]."""
    sigma_1: float
    """Bristle damping per normal force [s/m]."""
    sigma_2: float
    """Viscous friction per normal force [s/m]."""


@compiled
def level(law, speed):
    """Friction level g = mu_c + (mu_s - mu_c) exp(-(speed / v_s)^gamma) [-]."""
    ratio = speed / law.stribeck_velocity
    power = ratio * ratio if law.stribeck_exponent == 2.0 else ratio**law.stribeck_exponent
    if power > 40.0:  # exp(-40) is below the rounding of mu_c
        return law.mu_c
    return law.mu_c + (law.mu_s - law.mu_c) * math.exp(-power)


@compiled
def patch_step(law, cells, state, v_x, v_y, omega, normal, h):
    """Advance all cells by a prescribed slip twist at the centre of pressure.

    Args:
        law: The `Law`.
        cells: Rows x [m], y [m] and share w, shape (3, n).
        state: Rows z_x [m], z_y [m] and cap [m/s], shape (3, n); updated.
        v_x: Slip velocity of the object along x [m/s].
        v_y: Slip velocity of the object along y [m/s].
        omega: Slip rate of rotation [rad/s].
        normal: Normal force [N].
        h: Step [s].

    Returns:
        Friction (f_x, f_y, tau) on the object [N, N, N m].
    """
    sum_x, sum_y, moment = 0.0, 0.0, 0.0
    damping = law.sigma_1 / h
    for i in range(cells.shape[1]):
        x, y = cells[0, i], cells[1, i]
        u_x, u_y = v_x - omega * y, v_y + omega * x
        speed = min(math.sqrt(u_x * u_x + u_y * u_y), state[2, i])
        reach = level(law, speed) / law.sigma_0

        z_x, z_y = state[0, i], state[1, i]
        length = math.sqrt(z_x * z_x + z_y * z_y)
        if length > reach:
            z_x, z_y = z_x * (reach / length), z_y * (reach / length)

        end_x, end_y = z_x + h * u_x, z_y + h * u_y
        length = math.sqrt(end_x * end_x + end_y * end_y)
        state[2, i] = speed
        if length > reach:
            end_x, end_y = end_x * (reach / length), end_y * (reach / length)
            state[2, i] = math.inf
        state[0, i], state[1, i] = end_x, end_y

        f_x = cells[2, i] * (law.sigma_0 * end_x + damping * (end_x - z_x) + law.sigma_2 * u_x)
        f_y = cells[2, i] * (law.sigma_0 * end_y + damping * (end_y - z_y) + law.sigma_2 * u_y)
        sum_x, sum_y, moment = sum_x + f_x, sum_y + f_y, moment + x * f_y - y * f_x
    return -normal * sum_x, -normal * sum_y, -normal * moment
