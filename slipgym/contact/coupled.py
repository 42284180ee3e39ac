"""One implicit friction step of an object held by several pads at once.

The unknown is the motion q = (x, y, theta) of the object's centre of mass relative
to the pads within the sub-step. It solves the momentum balance

    M (q - q_free) / h^2 + sum_i S_i^T f_i(S_i q) = 0,

with S_i the map from q to the scaled displacement at pad i's centre of pressure
and f_i its friction (`slipgym.contact.kinds`).
"""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact.kinds import (
    detach,
    friction_and_jacobian,
    lever,
    scaled_displacement,
    set_friction_level,
    store_state,
    update_friction_level,
)
from slipgym.contact.records import Pad, Pads, Pair, Symmetric, Vector

MAX_NEWTON = 30
MAX_HALVINGS = 8
FROM_GUESS, FROM_REST, AGAIN = range(3)
FORCE_TOLERANCE = 1e-10  # of the friction limit; rounding reaches about 1e-13


@compiled
def assemble(
    pads: Pads,
    cells: np.ndarray | None,
    levels: Pair,
    inertia: Pair,
    centre: Pair,
    free: Vector,
    motion: Vector,
    h: float,
) -> tuple[Vector, Symmetric]:
    """Residual of the momentum balance and its symmetric derivative."""
    rate = 1.0 / h
    jx, jt = inertia[0] * rate * rate, inertia[1] * rate * rate
    rx, ry, rt = jx * (motion[0] - free[0]), jx * (motion[1] - free[1]), jt * (motion[2] - free[2])
    jy, jxy, jxt, jyt = jx, 0.0, 0.0, 0.0
    for i in range(len(pads)):
        if pads[i].normal > 0.0:
            force, d = friction_and_jacobian(pads[i], cells, i, levels[i], lever(pads[i], centre), motion, h)
            rx, ry, rt = rx + force[0], ry + force[1], rt + force[2]
            jx, jy, jt = jx + d[0], jy + d[1], jt + d[2]
            jxy, jxt, jyt = jxy + d[3], jxt + d[4], jyt + d[5]
    return (rx, ry, rt), (jx, jy, jt, jxy, jxt, jyt)


@compiled
def solve_symmetric(a: Symmetric, b: Vector) -> Vector:
    """Solve the symmetric positive definite system a x = b, a = (xx, yy, tt, xy, xt, yt).

    By the cofactors: one division instead of three in a row. Rounding grows with the condition number
    more than in a factorisation; the Newton iteration stops by the residual, so this does no harm.
    """
    xx, yy, tt, xy, xt, yt = a
    c_xx, c_yy, c_tt = yy * tt - yt * yt, xx * tt - xt * xt, xx * yy - xy * xy
    c_xy, c_xt, c_yt = xt * yt - xy * tt, xy * yt - xt * yy, xy * xt - xx * yt
    scale = 1.0 / (xx * c_xx + xy * c_xy + xt * c_xt)
    return (
        scale * (c_xx * b[0] + c_xy * b[1] + c_xt * b[2]),
        scale * (c_xy * b[0] + c_yy * b[1] + c_yt * b[2]),
        scale * (c_xt * b[0] + c_yt * b[1] + c_tt * b[2]),
    )


@compiled
def norm(residual: Vector, radius: float) -> float:
    """Length of a residual, its torque divided by a radius [N]."""
    return math.sqrt(residual[0] ** 2 + residual[1] ** 2 + (residual[2] / radius) ** 2)


@compiled
def solve_motion(
    pads: Pads,
    cells: np.ndarray | None,
    levels: Pair,
    inertia: Pair,
    centre: Pair,
    free: Vector,
    motion: Vector,
    h: float,
) -> Vector:
    """Damped semi-smooth Newton iteration for the motion that balances momentum and friction.

    If it does not converge from the guess, it is repeated from rest, which lies on the other side of the
    break-away; the better result is returned. It is the last that was evaluated: soft pads keep its results.
    The equation stands once in the loops below: each copy of it would be compiled, and kept in the cache.
    """
    tolerance = 0.0
    for i in range(len(pads)):
        tolerance += FORCE_TOLERANCE * levels[i] * pads[i].normal
    best, least, attempt = motion, math.inf, FROM_GUESS
    while True:
        motion, error = iterate(pads, cells, levels, inertia, centre, free, motion, h, tolerance, attempt)
        if not error > tolerance or attempt == AGAIN:
            return motion
        if attempt == FROM_REST:
            if error < least:
                return motion
            motion, attempt = best, AGAIN
        else:
            best, least, motion, attempt = motion, error, (0.0, 0.0, 0.0), FROM_REST


@compiled
def iterate(
    pads: Pads,
    cells: np.ndarray | None,
    levels: Pair,
    inertia: Pair,
    centre: Pair,
    free: Vector,
    motion: Vector,
    h: float,
    tolerance: float,
    attempt: int,
) -> tuple[Vector, float]:
    """Newton iteration from a first guess; returns the motion and the norm of its residual [N].

    With `attempt` AGAIN only the residual at the guess is evaluated.
    """
    radius = pads[0].radius
    start, step, part, before, error = motion, (0.0, 0.0, 0.0), 1.0, math.inf, 0.0
    steps, halvings = 0, 0
    while True:
        residual, jacobian = assemble(pads, cells, levels, inertia, centre, free, motion, h)
        error = norm(residual, radius)
        if steps > 0 and not error < before and halvings + 1 < MAX_HALVINGS:
            halvings, part = halvings + 1, 0.5 * part
        else:
            if error <= tolerance or steps == MAX_NEWTON or attempt == AGAIN:
                return motion, error
            step = solve_symmetric(jacobian, residual)
            part, start, before, steps, halvings = 1.0, motion, error, steps + 1, 0
        motion = (start[0] - part * step[0], start[1] - part * step[1], start[2] - part * step[2])


@compiled
def bristles(pad: Pad) -> Vector:
    """Bristle deflection [m]."""
    return pad.z[0], pad.z[1], pad.z[2]


@compiled
def step_pads(
    pads: Pads, cells: np.ndarray | None, inertia: Pair, centre: Pair, free: Vector, guess: Vector, h: float
) -> Vector:
    """Advance all pads and the object's motion relative to them by one sub-step.

    Args:
        pads: PAD records of the one or two pads that hold the object, an array or a tuple; updated.
            A tuple is faster: numba counts references to an array, which takes as long as the friction.
        cells: Their patches, shape (p, CELL_FIELDS, n); updated. None for hard ellipsoids, (p, 0) for pads
            that are soft or discs.
        inertia: Mass [kg] and moment of inertia about the centre of mass [kg m^2].
        centre: Centre of mass in the pad frame [m].
        free: Motion (x, y, theta) of the centre of mass relative to the pads in this
            sub-step without friction [m, m, rad].
        guess: First guess of the motion with friction.
        h: Sub-step [s].

    Returns:
        Motion (x, y, theta) with friction [m, m, rad].
    """
    before = bristles(pads[0]), bristles(pads[-1])
    first = set_friction_level(pads[0], cells, 0, h)
    levels = first, first if len(pads) == 1 else set_friction_level(pads[-1], cells, -1, h)
    held = pads[0].normal > 0.0 or pads[-1].normal > 0.0
    motion, anew = guess, False
    while True:  # at most twice; what is written once is compiled once
        motion = solve_motion(pads, cells, levels, inertia, centre, free, motion, h) if held else free
        slips = (
            scaled_displacement(pads[0], cells, lever(pads[0], centre), motion),
            scaled_displacement(pads[-1], cells, lever(pads[-1], centre), motion),
        )
        if anew or not held:
            break
        first = update_friction_level(pads[0], cells, 0, levels[0], before[0], slips[0], h)
        last = first
        if len(pads) > 1:
            last = update_friction_level(pads[-1], cells, -1, levels[1], before[1], slips[1], h)
        if first == levels[0] and last == levels[1]:
            break
        levels, anew = (first, last), True
    for i in range(len(pads)):
        if pads[i].normal > 0.0:
            store_state(pads[i], cells, i, levels[i], slips[i], h)
        else:
            detach(pads[i], cells, i, slips[i], h)
    return motion
