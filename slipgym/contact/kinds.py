"""The friction of a pad of any kind, about the object's centre of mass.

Pads are hard ellipsoids (`slipgym.contact.ellipsoid_kernel`), soft or discs (`slipgym.contact.soft_kernel`),
or patches of cells (`slipgym.contact.distributed_kernel`). The type of `cells` says which, so that each kind
is compiled separately: None, an array without numbers (p, 0), or patches (p, CELL_FIELDS, m).
The derivative of a bristle's friction is a multiple of the identity less a dyad, so an
ellipsoid's pull-back needs no matrix products.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact import cell_levels, distributed_kernel, ellipsoid_kernel, soft_kernel
from slipgym.contact.records import Pad, Pair, Symmetric, Vector
from slipgym.contact.soft_pad import let_go, load_pad, prepare_shear

PATCHES = 3
"""Dimensions of `cells` if they are patches, (p, CELL_FIELDS, m)."""


@compiled
def lever(pad: Pad, centre: Pair) -> Pair:
    """Vector from the centre of mass to the pad's centre of pressure [m]."""
    return pad.pressure_centre[0] - centre[0], pad.pressure_centre[1] - centre[1]


@compiled
def scaled_displacement(pad: Pad, cells: np.ndarray | None, arm: Pair, motion: Vector) -> Vector:
    """Scaled displacement S q at the centre of pressure."""
    x, y = motion[0] - motion[2] * arm[1], motion[1] + motion[2] * arm[0]
    if cells is None:
        return x, y, pad.radius * motion[2]
    return pad.axes[0] * x, pad.axes[1] * y, pad.radius * motion[2]


@compiled
def even_force(pad: Pad, arm: Pair, vector: Vector) -> Vector:
    """Generalised force S^T f about the centre of mass, of a pad that is the same in all directions."""
    return vector[0], vector[1], arm[0] * vector[1] - arm[1] * vector[0] + pad.radius * vector[2]


@compiled
def generalised_stiffness(pad: Pad, arm: Pair, a: Symmetric) -> Symmetric:
    """S^T a S of a symmetric a = (xx, yy, tt, xy, xt, yt)."""
    xx, yy, tt, xy, xt, yt = a
    u, v = pad.axes
    xx, yy, xy, xt, yt = u * u * xx, v * v * yy, u * v * xy, u * xt, v * yt
    x, y, r = arm[0], arm[1], pad.radius
    turn_x = x * xy - y * xx + r * xt
    turn_y = x * yy - y * xy + r * yt
    turn_t = x * yt - y * xt + r * tt
    return xx, yy, x * turn_y - y * turn_x + r * turn_t, xy, turn_x, turn_y


@compiled
def set_normal(pad: Pad, cells: np.ndarray | None, normal: float) -> None:
    """Set a pad's normal force [N] and, if it is not a hard ellipsoid, what depends on it."""
    if cells is None:
        pad.normal = normal
    else:
        load_pad(pad, normal)


@compiled
def set_friction_level(pad: Pad, cells: np.ndarray | None, i: int, h: float) -> float:
    """Set the friction levels of a sub-step; returns their mean over the load [-]."""
    if cells is None:
        return ellipsoid_kernel.set_friction_level(pad, h)
    if cells.ndim == PATCHES:
        prepare_shear(pad, h, 0.0)
        twist = cell_levels.expected_twist(pad, h)
        return cell_levels.set_friction_levels(pad, cells[i], twist)
    return soft_kernel.set_friction_level(pad, h)


@compiled
def friction_and_jacobian(
    pad: Pad, cells: np.ndarray | None, i: int, level: float, arm: Pair, motion: Vector, h: float
) -> tuple[Vector, Symmetric]:
    """Generalised friction force of one pad about the centre of mass, and its derivative."""
    delta = scaled_displacement(pad, cells, arm, motion)
    if cells is not None:
        if cells.ndim == PATCHES:
            force, derivative = distributed_kernel.friction_and_jacobian(pad, cells[i], delta, h)
        else:
            force, derivative = soft_kernel.friction_and_jacobian(pad, delta, level)
        force = pad.axes[0] * force[0], pad.axes[1] * force[1], force[2]
        return even_force(pad, arm, force), generalised_stiffness(pad, arm, derivative)
    force, isotropic, radial, direction, _, _ = ellipsoid_kernel.friction_and_jacobian(pad, delta, h, level)
    nx, ny, nt = even_force(pad, arm, direction)
    return even_force(pad, arm, force), (
        isotropic - radial * nx * nx,
        isotropic - radial * ny * ny,
        isotropic * (arm[0] ** 2 + arm[1] ** 2 + pad.radius**2) - radial * nt * nt,
        -radial * nx * ny,
        -(isotropic * arm[1] + radial * nx * nt),
        isotropic * arm[0] - radial * ny * nt,
    )


@compiled
def update_friction_level(
    pad: Pad, cells: np.ndarray | None, i: int, level: float, before: Vector, delta: Vector, h: float
) -> float:
    """Set the friction levels anew if a solved slip displacement gives others; returns their mean [-]."""
    if cells is None:
        return ellipsoid_kernel.update_friction_level(pad, before, delta, h, level)
    if cells.ndim == PATCHES:
        return cell_levels.update_friction_levels(pad, cells[i], delta, h, level)
    return soft_kernel.update_friction_level(pad, before, h, level)


@compiled
def store_state(pad: Pad, cells: np.ndarray | None, i: int, level: float, delta: Vector, h: float) -> None:
    """Store the state of a pad after a scaled slip displacement."""
    if cells is None:
        ellipsoid_kernel.store_state(pad, delta, h, level)
    elif cells.ndim == PATCHES:
        distributed_kernel.store_state(pad, cells[i], delta, h)
    else:
        soft_kernel.store_state(pad, delta, h, level)


@compiled
def detach(pad: Pad, cells: np.ndarray | None, i: int, delta: Vector, h: float) -> None:
    """Reset the bristles of a pad without normal force, after a scaled slip displacement."""
    if cells is not None:
        let_go(pad)
        if cells.ndim == PATCHES:
            distributed_kernel.detach(pad, cells[i], (delta[0] / h, delta[1] / h, delta[2] / h))
            return
    ellipsoid_kernel.detach(pad, math.sqrt(delta[0] ** 2 + delta[1] ** 2 + delta[2] ** 2) / h)
