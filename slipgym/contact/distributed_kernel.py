"""The friction step of a patch: an elasto-plastic return mapping in every cell.

Cell i lies at x_i from the centre of pressure and carries the share w_i of the normal
force f_n (LuGre patch of Waltersson & Karayiannidis, arXiv 2308.01123):

    v_i = v + omega x x_i                              slip velocity of the cell
    g_i = mu_c + (mu_s - mu_c) exp(-(s_i / v_s)^gamma)
    f_i = w_i f_n (sigma_0 z_i + sigma_1 dz_i/dt + sigma_2 v_i),    |z_i| <= g_i / sigma_0
    F = -sum f_i,    tau = -sum x_i x f_i

A cell is a bristle of `slipgym.contact.ellipsoid_kernel`, in two dimensions: z_i is brought
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

The loops are written to run on several cells at once: a quantity of all cells is a row in
memory, a branch is a choice between two values, and no loop calls the mathematical library.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled, compiled_sum
from slipgym.contact import ellipsoid_kernel as kernel
from slipgym.contact.decay import LARGEST, decay
from slipgym.contact.records import CAP, KEPT, REACH, SHARE, Z_X, Z_Y, X, Y

FLAT = 3.0  # slip speed over v_s from which the Stribeck curve has decayed, to exp(-9)
MOSTLY = 0.5  # of the load, on cells that slip: the patch does


@compiled
def length(vector):
    """Length of a tuple of 3."""
    return math.sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2])


@compiled
def at_cell(x, y, motion):
    """Displacement or velocity of a cell, a tuple of 3 with zero spin."""
    return motion[0] - motion[2] * y, motion[1] + motion[2] * x, 0.0


@compiled
def speed_at(x, y, cap, twist):
    """Slip speed of a cell by which its friction level goes [m/s]."""
    v_x, v_y, _ = at_cell(x, y, twist)
    return min(math.sqrt(v_x * v_x + v_y * v_y), cap)


@compiled
def expected_twist(pad, h):
    """Scaled slip twist expected in the middle of a sub-step of h [m/s]."""
    ahead = pad.half_step + 0.5 * h
    return (
        pad.twist[0] + ahead * pad.twist_rate[0],
        pad.twist[1] + ahead * pad.twist_rate[1],
        pad.twist[2] + ahead * pad.twist_rate[2],
    )


@compiled
def set_powers(pad, cells, twist):
    """Write (s_i / v_s)^gamma of every cell into REACH; returns how many cells feel mu_s at all."""
    x, y, cap, power = cells[X], cells[Y], cells[CAP], cells[REACH]
    per_unit, slow = 1.0 / pad.stribeck_velocity, 0
    if pad.stribeck_exponent == 2.0:
        for i in range(cells.shape[1]):
            ratio = speed_at(x[i], y[i], cap[i], twist) * per_unit
            power[i] = ratio * ratio
            slow += ratio * ratio < LARGEST
    else:  # cell by cell, as the processor has no such operation
        for i in range(cells.shape[1]):
            power[i] = (speed_at(x[i], y[i], cap[i], twist) * per_unit) ** pad.stribeck_exponent
            slow += power[i] < LARGEST
    return slow


@compiled_sum
def prepare(pad, cells, twist):
    """Fix every cell's friction level and bring its bristle into it; once more in a step is the same as once.

    Args:
        pad: PAD record with the parameters.
        cells: Patch (CELL_FIELDS, n); updated.
        twist: Scaled slip twist to come, tuple of 3 [m/s].

    Returns:
        Friction level, mean over the load [-].
    """
    share, z_x, z_y, reach, kept = cells[SHARE], cells[Z_X], cells[Z_Y], cells[REACH], cells[KEPT]
    mu_c, mu_s, compliance, mean = pad.mu_c, pad.mu_s, 1.0 / pad.sigma_0, 0.0
    if set_powers(pad, cells, twist) > 0:
        for i in range(cells.shape[1]):
            reach[i] = kernel.level(mu_c, mu_s, decay(reach[i]))
    else:
        reach[:] = mu_c
    for i in range(cells.shape[1]):
        mean += share[i] * reach[i]
        reach[i] *= compliance
        x, y = z_x[i] / kept[i], z_y[i] / kept[i]
        kept[i] = kernel.kept((x, y, 0.0), reach[i])
        z_x[i], z_y[i] = kept[i] * x, kept[i] * y
    return mean


@compiled_sum
def respond(pad, cells, delta, h):
    """Friction of all cells after a scaled slip displacement over time h.

    Args:
        pad: PAD record with the parameters and the normal force.
        cells: Patch (CELL_FIELDS, n) from `prepare`; read only.
        delta: Scaled slip displacement (x, y, r theta) of the sub-step, tuple of 3 [m].
        h: Sub-step [s].

    Returns:
        force: Friction opposing `delta`, scaled components, tuple of 3 [N].
        derivative: Of `force` by `delta`, symmetric (xx, yy, tt, xy, xt, yt) [N/m].
    """
    xs, ys, share = cells[X], cells[Y], cells[SHARE]
    z_x, z_y, reach = cells[Z_X], cells[Z_Y], cells[REACH]
    fx, fy, ft = 0.0, 0.0, 0.0
    xx, yy, tt, xy, xt, yt = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(cells.shape[1]):
        x, y = xs[i], ys[i]
        # as if it carried the whole normal force: what does not differ is computed once
        force, isotropic, radial, direction, _ = kernel.respond(
            pad, (z_x[i], z_y[i], 0.0), pad.normal, at_cell(x, y, delta), h, reach[i]
        )
        f_x, f_y = share[i] * force[0], share[i] * force[1]
        isotropic, radial = share[i] * isotropic, share[i] * radial
        n_x, n_y, _ = direction
        n_t = x * n_y - y * n_x
        fx, fy, ft = fx + f_x, fy + f_y, ft + (x * f_y - y * f_x)
        xx += isotropic - radial * n_x * n_x
        yy += isotropic - radial * n_y * n_y
        tt += isotropic * (x * x + y * y) - radial * n_t * n_t
        xy -= radial * n_x * n_y
        xt -= isotropic * y + radial * n_x * n_t
        yt += isotropic * x - radial * n_y * n_t
    return (fx, fy, ft), (xx, yy, tt, xy, xt, yt)


@compiled_sum
def advance(pad, cells, delta, twist, h):
    """Store bristles and caps after a scaled slip displacement.

    Returns:
        Friction opposing it, tuple of 3 [N], and the share of the load on cells that slip [-].
    """
    xs, ys, share, cap = cells[X], cells[Y], cells[SHARE], cells[CAP]
    z_x, z_y, reach, kept = cells[Z_X], cells[Z_Y], cells[REACH], cells[KEPT]
    fx, fy, ft, slipping = 0.0, 0.0, 0.0, 0.0
    for i in range(cells.shape[1]):
        x, y = xs[i], ys[i]
        stuck = speed_at(x, y, cap[i], twist)
        force, _, _, trial, shortening = kernel.respond(
            pad, (z_x[i], z_y[i], 0.0), pad.normal, at_cell(x, y, delta), h, reach[i]
        )
        f_x, f_y = share[i] * force[0], share[i] * force[1]
        fx, fy, ft = fx + f_x, fy + f_y, ft + (x * f_y - y * f_x)
        z_x[i], z_y[i] = shortening * trial[0], shortening * trial[1]
        cap[i] = math.inf if shortening < 1.0 else stuck
        slipping += share[i] if shortening < 1.0 else 0.0
        kept[i] = 1.0
    return (fx, fy, ft), slipping


@compiled
def revise(pad, cells, delta, h, limit):
    """Fix the friction levels anew that a scaled slip displacement turns out to mean, if they are others.

    Args:
        pad: PAD record.
        cells: Patch (CELL_FIELDS, n) from `prepare`; updated.
        delta: Scaled slip displacement under these levels, tuple of 3 [m].
        h: Sub-step [s].
        limit: Their mean over the load [-].

    Returns:
        The mean; `limit` if it is near.
    """
    expected, found = expected_twist(pad, h), (delta[0] / h, delta[1] / h, delta[2] / h)
    away = length((found[0] - expected[0], found[1] - expected[1], found[2] - expected[2]))
    fast = (
        limit - pad.mu_c < kernel.LEVEL_TOLERANCE * pad.mu_c
        and math.hypot(found[0], found[1]) > FLAT * pad.stribeck_velocity
    )
    if fast or kernel.near(pad, away):
        return limit  # without a look at the cells
    mean = prepare(pad, cells, found)
    return mean if abs(mean - limit) > kernel.LEVEL_TOLERANCE * limit else prepare(pad, cells, expected)


@compiled
def commit(pad, cells, delta, h):
    """Store bristle states, slip twist and wrench after a scaled slip displacement."""
    between, pad.half_step = pad.half_step + 0.5 * h, 0.5 * h
    for a in range(3):
        pad.twist_rate[a] = (delta[a] / h - pad.twist[a]) / between
        pad.twist[a] = delta[a] / h
    twist = pad.twist[0], pad.twist[1], pad.twist[2]
    force, slipping = advance(pad, cells, delta, twist, h)
    speed = length(twist)
    pad.slip_rate = (speed - pad.slip_speed) / between if slipping > MOSTLY else 0.0
    pad.slip_speed = speed
    pad.wrench[0], pad.wrench[1], pad.wrench[2] = -force[0], -force[1], -pad.r * force[2]


@compiled
def release(pad, cells, twist):
    """Forget the bristle states of a patch without normal force."""
    pad.wrench[:] = 0.0
    pad.slip_speed, pad.slip_rate = length(twist), 0.0
    for a in range(3):
        pad.twist[a] = twist[a]
        pad.twist_rate[a] = 0.0
    cells[Z_X], cells[Z_Y], cells[KEPT], cells[CAP] = 0.0, 0.0, 1.0, math.inf


@compiled
def prescribed_step(pads, cells, v_x, v_y, omega, normal, h):
    """Advance a patch by a prescribed slip twist at its centre of pressure.

    Args:
        pads: PAD (1,); updated. An array, since numba takes in a record of Python's ten times as slowly.
        cells: Patch (CELL_FIELDS, n); updated.
        v_x: Slip twist, with `v_y` and `omega` [m/s, m/s, rad/s].
        v_y: See `v_x`.
        omega: See `v_x`.
        normal: Normal force, > 0 [N].
        h: Time step [s].

    Returns:
        Friction (f_x, f_y, tau) on the object [N, N, N m].
    """
    pad = pads[0]
    pad.normal = normal
    twist = (v_x, v_y, pad.r * omega)
    prepare(pad, cells, twist)
    commit(pad, cells, (h * twist[0], h * twist[1], h * twist[2]), h)
    return pad.wrench[0], pad.wrench[1], pad.wrench[2]
