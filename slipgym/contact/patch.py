"""The friction step of a patch: an elasto-plastic return mapping in every cell.

Cell i lies at x_i from the centre of pressure and carries the share w_i of the normal
force f_n (LuGre patch of Waltersson & Karayiannidis, arXiv 2308.01123):

    v_i = v + omega x x_i                              slip velocity of the cell
    g_i = mu_c + (mu_s - mu_c) exp(-(s_i / v_s)^gamma)
    f_i = w_i f_n (sigma_0 z_i + sigma_1 dz_i/dt + sigma_2 v_i),    |z_i| <= g_i / sigma_0
    F = -sum f_i,    tau = -sum x_i x f_i

A cell is a bristle of `slipgym.contact.kernel`, in two dimensions: z_i is brought
into the ball if g_i has fallen, which is loss and not dz_i/dt; then v_i h is added and the
result projected onto the ball. Hence it truly sticks, takes at least the energy that it
stores whatever the twist, and has no limit sigma_0 |v| h / g < 1. Steady slip is LuGre's:
z_i = g_i v_i / (sigma_0 |v_i|), in which it arrives along the shortest way and not
exponentially. The exponential step of LuGre has no limit either; but it drifts in stick
or needs a switching function, and passivity would rest on that function.

s_i is |v_i| in slip. In stick it only falls (elastic motion must not lower g), which one
number a cell keeps: the cap, infinite in slip. |v_i| is that of the twist to come: known if
it is prescribed, otherwise extrapolated from the last two sub-steps. With s_i so fixed the
friction of all cells is the gradient of a convex function of the twist.

Twists and displacements are scaled, (x, y, r theta), as the ellipsoid's; x_i is in units of r.
"""

from __future__ import annotations

import math

from slipgym.compiled import compiled
from slipgym.contact import kernel


@compiled
def at_cell(cell, motion):
    """Displacement or velocity of a cell, a tuple of 3 with zero spin."""
    return motion[0] - motion[2] * cell.y, motion[1] + motion[2] * cell.x, 0.0


@compiled
def speed_at(cell, twist):
    """Slip speed of a cell by which its friction level goes [m/s]."""
    v_x, v_y, _ = at_cell(cell, twist)
    return min(math.sqrt(v_x * v_x + v_y * v_y), cell.cap)


@compiled
def expected_twist(pad, h):
    """Scaled slip twist expected after a sub-step of h [m/s]."""
    return (
        pad.twist[0] + h * pad.twist_rate[0],
        pad.twist[1] + h * pad.twist_rate[1],
        pad.twist[2] + h * pad.twist_rate[2],
    )


@compiled
def prepare(pad, cells, twist):
    """Fix every cell's friction level and bring its bristle into it.

    Args:
        pad: PAD record with the parameters.
        cells: CELL (n,); updated.
        twist: Scaled slip twist to come, tuple of 3 [m/s].

    Returns:
        Friction level, mean over the load [-].
    """
    mean = 0.0
    for i in range(cells.shape[0]):
        cell = cells[i]
        limit = kernel.stribeck(pad, speed_at(cell, twist))
        mean += cell.share * limit
        cell.reach = limit / pad.sigma_0
        cell.z_x, cell.z_y, _ = kernel.brought_in((cell.z_x, cell.z_y, 0.0), cell.reach)
    return mean


@compiled
def respond(pad, cells, delta, h):
    """Friction of all cells after a scaled slip displacement over time h.

    Args:
        pad: PAD record with the parameters and the normal force.
        cells: CELL (n,) from `prepare`; read only.
        delta: Scaled slip displacement (x, y, r theta) of the sub-step, tuple of 3 [m].
        h: Sub-step [s].

    Returns:
        force: Friction opposing `delta`, scaled components, tuple of 3 [N].
        derivative: Of `force` by `delta`, symmetric (xx, yy, tt, xy, xt, yt) [N/m].
    """
    fx, fy, ft = 0.0, 0.0, 0.0
    xx, yy, tt, xy, xt, yt = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(cells.shape[0]):
        cell = cells[i]
        x, y = cell.x, cell.y
        z = (cell.z_x, cell.z_y, 0.0)
        # as if it carried the whole normal force: what does not differ is computed once
        force, isotropic, radial, direction, _ = kernel.respond(
            pad, z, pad.normal, at_cell(cell, delta), h, cell.reach
        )
        f_x, f_y = cell.share * force[0], cell.share * force[1]
        isotropic, radial = cell.share * isotropic, cell.share * radial
        n_x, n_y, _ = direction
        n_t = x * n_y - y * n_x
        fx, fy, ft = fx + f_x, fy + f_y, ft + x * f_y - y * f_x
        xx += isotropic - radial * n_x * n_x
        yy += isotropic - radial * n_y * n_y
        tt += isotropic * (x * x + y * y) - radial * n_t * n_t
        xy -= radial * n_x * n_y
        xt -= isotropic * y + radial * n_x * n_t
        yt += isotropic * x - radial * n_y * n_t
    return (fx, fy, ft), (xx, yy, tt, xy, xt, yt)


@compiled
def commit(pad, cells, delta, h):
    """Store bristle states, slip twist and wrench after a scaled slip displacement."""
    for a in range(3):
        pad.twist_rate[a] = (delta[a] / h - pad.twist[a]) / h
        pad.twist[a] = delta[a] / h
    twist = (pad.twist[0], pad.twist[1], pad.twist[2])
    fx, fy, ft = 0.0, 0.0, 0.0
    for i in range(cells.shape[0]):
        cell = cells[i]
        z = (cell.z_x, cell.z_y, 0.0)
        force, _, _, trial, shortening = kernel.respond(
            pad, z, pad.normal, at_cell(cell, delta), h, cell.reach
        )
        f_x, f_y = cell.share * force[0], cell.share * force[1]
        fx, fy, ft = fx + f_x, fy + f_y, ft + cell.x * f_y - cell.y * f_x
        cell.z_x, cell.z_y = shortening * trial[0], shortening * trial[1]
        cell.cap = math.inf if shortening < 1.0 else speed_at(cell, twist)
    pad.wrench[0], pad.wrench[1], pad.wrench[2] = -fx, -fy, -pad.r * ft


@compiled
def release(pad, cells, twist):
    """Forget the bristle states of a patch without normal force."""
    pad.wrench[:] = 0.0
    for a in range(3):
        pad.twist[a] = twist[a]
        pad.twist_rate[a] = 0.0
    for i in range(cells.shape[0]):
        cell = cells[i]
        cell.z_x, cell.z_y, cell.cap = 0.0, 0.0, math.inf


@compiled
def prescribed_step(pad, cells, twist, h):
    """Advance a patch by a prescribed slip twist (v_x, v_y, omega) at its centre of pressure."""
    scaled = (twist[0], twist[1], pad.r * twist[2])
    prepare(pad, cells, scaled)
    commit(pad, cells, (h * scaled[0], h * scaled[1], h * scaled[2]), h)
