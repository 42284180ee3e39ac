"""The friction step of a patch: an elasto-plastic return mapping in every cell.

Cell i lies at x_i from the centre of pressure and carries the fraction w_i of the normal
force f_n (LuGre patch of Waltersson & Karayiannidis, arXiv 2308.01123):

    v_i = v + omega x x_i                              slip velocity of the cell
    g_i = g(s_i)                                       `slipgym.contact.stribeck`
    f_i = w_i f_n (sigma_0 z_i + sigma_1 dz_i/dt + sigma_2 v_i),    |z_i| <= g_i / sigma_0
    F = -sum f_i,    tau = -sum x_i x f_i

A cell is a bristle of `slipgym.contact.bristle`, in two dimensions: z_i is brought
into the ball if g_i has fallen, which is loss and not dz_i/dt; then v_i h is added and the
result projected onto the ball. Hence it truly sticks, takes at least the energy that it
stores whatever the twist, and has no limit sigma_0 |v| h / g < 1. Steady slip is LuGre's:
z_i = g_i v_i / (sigma_0 |v_i|), in which it arrives along the shortest way and not
exponentially. The exponential step of LuGre has no limit either; but it drifts in stick
or needs a switching function, and passivity would rest on that function.

s_i is |v_i| in slip. In stick it only falls (elastic motion must not lower g): each cell
keeps an upper bound of it, its speed cap, infinite in slip. |v_i| is that of the coming twist: known if
it is prescribed, otherwise extrapolated from the last two sub-steps. With s_i so fixed the
friction of all cells is the gradient of a convex function of the twist.

Twists and displacements are scaled, (x, y, r theta), as the ellipsoid's; x_i is in units of r.

The loops are written to run on several cells at once: a quantity of all cells is a row in
memory, a branch is a choice between two values, and no loop calls the mathematical library.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled, compiled_sum, inlined_sum
from slipgym.contact import bristle
from slipgym.contact.cell_levels import at_cell, length, set_friction_levels, speed_at
from slipgym.contact.records import (
    ELASTIC_LIMIT,
    LOAD,
    RELAXED_X,
    RELAXED_Y,
    RETENTION,
    SHEAR_X,
    SHEAR_Y,
    SPEED_CAP,
    Z_X,
    Z_Y,
    Cells,
    Pad,
    Pair,
    Symmetric,
    Vector,
    X,
    Y,
)
from slipgym.contact.soft_pad import advance_age, load_pad, prepare_shear, sheared

SLIPPING = 0.5
"""Fraction of the load on slipping cells above which the patch counts as slipping [-]."""


@compiled
def rear_of(cells: Cells, i: int, give: float, recall: Pair) -> Vector:
    """Remembered shear of the rubber behind a cell [m]; 0 without `give`."""
    if give > 0.0:
        now, before = recall
        return (
            now * cells[SHEAR_X, i] + before * cells[RELAXED_X, i],
            now * cells[SHEAR_Y, i] + before * cells[RELAXED_Y, i],
            0.0,
        )
    return 0.0, 0.0, 0.0


@inlined_sum
def friction_sum(
    pad: Pad, cells: Cells, delta: Vector, h: float, give: float, recall: Pair
) -> tuple[Vector, Symmetric]:
    """`friction_and_jacobian`; called with the literal 0 for `give` it is compiled without rubber."""
    xs, ys, load = cells[X], cells[Y], cells[LOAD]
    z_x, z_y, limit = cells[Z_X], cells[Z_Y], cells[ELASTIC_LIMIT]
    fx, fy, ft = 0.0, 0.0, 0.0
    xx, yy, tt, xy, xt, yt = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(cells.shape[1]):
        x, y = xs[i], ys[i]
        # as if it carried the whole normal force: what does not differ is computed once
        rear, z = rear_of(cells, i, give, recall), (z_x[i], z_y[i], 0.0)
        force, isotropic, radial, direction, _, _ = bristle.friction_and_jacobian(
            pad, give, rear, z, pad.normal, at_cell(x, y, delta), h, limit[i]
        )
        f_x, f_y = load[i] * force[0], load[i] * force[1]
        isotropic, radial = load[i] * isotropic, load[i] * radial
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
def friction_and_jacobian(pad: Pad, cells: Cells, delta: Vector, h: float) -> tuple[Vector, Symmetric]:
    """Friction of all cells opposing a scaled displacement over time h [N], and its derivative by it [N/m].

    The cells are read only; `set_friction_levels` has prepared them.
    """
    if pad.give > 0.0:
        return friction_sum(pad, cells, delta, h, pad.give, (pad.recall[0], pad.recall[1]))
    return friction_sum(pad, cells, delta, h, 0.0, (0.0, 0.0))


@inlined_sum
def stored_sum(
    pad: Pad, cells: Cells, delta: Vector, twist: Vector, h: float, give: float, recall: Pair
) -> tuple[Vector, float]:
    """`store_cells`; called with the literal 0 for `give` it is compiled without rubber."""
    xs, ys, load, cap = cells[X], cells[Y], cells[LOAD], cells[SPEED_CAP]
    z_x, z_y, limit, kept = cells[Z_X], cells[Z_Y], cells[ELASTIC_LIMIT], cells[RETENTION]
    fx, fy, ft, slipping = 0.0, 0.0, 0.0, 0.0
    for i in range(cells.shape[1]):
        x, y = xs[i], ys[i]
        stuck = speed_at(x, y, cap[i], twist)
        rear, z, moved = rear_of(cells, i, give, recall), (z_x[i], z_y[i], 0.0), at_cell(x, y, delta)
        force, _, _, trial, shortening, slip = bristle.friction_and_jacobian(
            pad, give, rear, z, pad.normal, moved, h, limit[i]
        )
        f_x, f_y = load[i] * force[0], load[i] * force[1]
        fx, fy, ft = fx + f_x, fy + f_y, ft + (x * f_y - y * f_x)
        z_x[i], z_y[i] = shortening * trial[0], shortening * trial[1]
        cap[i] = math.inf if shortening < 1.0 else stuck
        slipping += load[i] if shortening < 1.0 else 0.0
        kept[i] = 1.0
        if give > 0.0:
            cells[SHEAR_X, i], cells[RELAXED_X, i] = sheared(
                pad, cells[SHEAR_X, i], cells[RELAXED_X, i], moved[0] - slip[0]
            )
            cells[SHEAR_Y, i], cells[RELAXED_Y, i] = sheared(
                pad, cells[SHEAR_Y, i], cells[RELAXED_Y, i], moved[1] - slip[1]
            )
    return (fx, fy, ft), slipping


@compiled_sum
def store_cells(pad: Pad, cells: Cells, delta: Vector, twist: Vector, h: float) -> tuple[Vector, float]:
    """Store bristles, speed caps and shear after a scaled displacement.

    Returns:
        Friction opposing it [N], and the fraction of the load on cells that slip [-].
    """
    if pad.give > 0.0:
        return stored_sum(pad, cells, delta, twist, h, pad.give, (pad.recall[0], pad.recall[1]))
    return stored_sum(pad, cells, delta, twist, h, 0.0, (0.0, 0.0))


@compiled
def store_state(pad: Pad, cells: Cells, delta: Vector, h: float) -> None:
    """Store bristle states, slip twist and wrench after a scaled slip displacement."""
    between, pad.half_step = pad.half_step + 0.5 * h, 0.5 * h
    for a in range(3):
        pad.twist_rate[a] = (delta[a] / h - pad.twist[a]) / between
        pad.twist[a] = delta[a] / h
    twist = pad.twist[0], pad.twist[1], pad.twist[2]
    force, slipping = store_cells(pad, cells, delta, twist, h)
    speed = length(twist)
    slips = slipping > SLIPPING
    pad.slip_rate = (speed - pad.slip_speed) / between if slips else 0.0
    pad.slip_speed = speed
    advance_age(pad, speed if slips else 0.0, h)
    pad.wrench[0], pad.wrench[1] = -pad.axes[0] * force[0], -pad.axes[1] * force[1]
    pad.wrench[2] = -pad.radius * force[2]


@compiled
def detach(pad: Pad, cells: Cells, twist: Vector) -> None:
    """Reset the bristles of a patch that carries no normal force."""
    pad.wrench[:] = 0.0
    pad.slip_speed, pad.slip_rate = length(twist), 0.0
    for a in range(3):
        pad.twist[a] = twist[a]
        pad.twist_rate[a] = 0.0
    cells[Z_X], cells[Z_Y], cells[RETENTION], cells[SPEED_CAP] = 0.0, 0.0, 1.0, math.inf
    for row in (SHEAR_X, SHEAR_Y, RELAXED_X, RELAXED_Y):
        cells[row] = 0.0


@compiled
def prescribed_step(
    pads: np.ndarray, cells: Cells, v_x: float, v_y: float, omega: float, normal: float, h: float
) -> Vector:
    """Advance a patch over h [s] by a prescribed slip twist at its centre of pressure [m/s, m/s, rad/s].

    `pads` is PAD (1,), an array: numba converts a single record ten times as slowly. `normal` is > 0 [N].

    Returns:
        Friction (f_x, f_y, tau) on the object [N, N, N m].
    """
    pad = pads[0]
    load_pad(pad, normal)
    prepare_shear(pad, h, 0.0)
    twist = (pad.axes[0] * v_x, pad.axes[1] * v_y, pad.radius * omega)
    set_friction_levels(pad, cells, twist)
    store_state(pad, cells, (h * twist[0], h * twist[1], h * twist[2]), h)
    return pad.wrench[0], pad.wrench[1], pad.wrench[2]
