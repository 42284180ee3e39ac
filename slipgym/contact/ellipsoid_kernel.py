"""The friction step of a hard pad: elasto-plastic return mapping onto an ellipsoidal limit surface.

Each pad carries three bristle deflections z in the scaled displacement
(x, y, r theta) at its centre of pressure. Friction per normal force is

    f / f_n = sigma_0 z + sigma_1 dz/dt + sigma_2 u,        |z| <= g(v) / sigma_0,

with u the scaled slip twist and g(v) the Stribeck curve (`slipgym.contact.stribeck`) of the slip speed v: |u|
where the contact slips; where it sticks v never rises, so that only slip lowers g and
a sub-step of stick amid slip does not restore it. (The plastic part of |u| alone would be
ill-posed: as g falls z must shrink, which reads as more plastic speed.) A sub-step
adds the scaled slip displacement to z and projects the result back onto the ball of
radius g / sigma_0 (closest-point return mapping, Simo & Hughes, Computational
Inelasticity, 1998, ch. 3). Inside the ball the contact truly sticks: z is elastic
and nothing drifts. On the ball z turns into the direction of slip, so steady slip
lies on the ellipsoid (Waltersson & Karayiannidis, arXiv 2507.06824, eqs 1-2; LuGre
form in arXiv 2308.01123). If g has fallen z is brought into the smaller ball first,
which counts as loss and not as dz/dt: elastic force and damping then take at least
the energy that they store, whatever the twist.

The step is backward Euler in the object's momentum, so it knows mass and inertia
and has no stiffness limit. g is that of the speed expected in the sub-step's middle,
extrapolated from the last two; with g so fixed each pad's force is the gradient of a
convex function of the twist: the coupled problem of both pads has one solution,
which a semi-smooth Newton iteration finds. If its speed means another g, as in a
break-away, where slip grows within a sub-step, g is set to that one and the problem is
solved once more.
"""

from __future__ import annotations

import math
from typing import Any

from slipgym._numba.compiled import compiled
from slipgym.contact import bristle
from slipgym.contact.records import Pad, Vector
from slipgym.contact.stribeck import LEVEL_TOLERANCE, level_at, level_unchanged

NONE: Vector = (0.0, 0.0, 0.0)
"""Memory of a hard pad's rubber."""


@compiled
def expected_speed(pad: Pad, h: float) -> float:
    """Slip speed expected in the middle of a sub-step of h [m/s]."""
    return max(0.0, pad.slip_speed + (pad.half_step + 0.5 * h) * pad.slip_rate)


@compiled
def friction_and_jacobian(pad: Pad, delta: Vector, h: float, level: float) -> tuple[Any, ...]:
    """`bristle.friction_and_jacobian` of a hard pad."""
    z = (pad.z[0], pad.z[1], pad.z[2])
    return bristle.friction_and_jacobian(pad, 0.0, NONE, z, pad.normal, delta, h, level / pad.sigma_0)


@compiled
def set_friction_level(pad: Pad, h: float) -> float:
    """Set the friction level of a sub-step and shorten the bristles to it; returns the level [-]."""
    level = level_at(pad, expected_speed(pad, h))
    shorten_bristles(pad, level)
    return level


@compiled
def shorten_bristles(pad: Pad, level: float) -> None:
    """Shorten the bristles to the elastic limit of a friction level."""
    fraction = bristle.retention((pad.z[0], pad.z[1], pad.z[2]), level / pad.sigma_0)
    if fraction < 1.0:  # a product with 1 would have stick wait for root and quotient, a fifth of a sub-step
        for a in range(3):
            pad.z[a] *= fraction


@compiled
def found_level(pad: Pad, slip: Vector, stuck: bool, h: float, level: float) -> float:
    """Friction level at the slip speed of a sub-step that was solved with `level` [-].

    `slip` is the scaled slip displacement [m], `stuck` whether the bristles stick after it. Returns `level`
    itself if the two differ by less than LEVEL_TOLERANCE.
    """
    expected = expected_speed(pad, h)
    if stuck and level_unchanged(pad, max(expected, pad.slip_speed)):
        return level
    speed = math.sqrt(slip[0] * slip[0] + slip[1] * slip[1] + slip[2] * slip[2]) * (1.0 / h)
    if stuck:
        speed = min(speed, pad.slip_speed)
    if level_unchanged(pad, speed - expected):
        return level
    found = level_at(pad, speed)
    return level if abs(found - level) <= LEVEL_TOLERANCE * level else found


@compiled
def update_friction_level(pad: Pad, before: Vector, delta: Vector, h: float, level: float) -> float:
    """Set the friction level anew if the solved displacement `delta` [m] gives another one.

    `before` are the bristles at the start of the sub-step [m]; returns the level, see `found_level`.
    """
    x, y, t = pad.z[0] + delta[0], pad.z[1] + delta[1], pad.z[2] + delta[2]
    elastic_limit = level / pad.sigma_0
    stuck = x * x + y * y + t * t <= elastic_limit * elastic_limit
    found = found_level(pad, delta, stuck, h, level)
    if found != level:
        for a in range(3):
            pad.z[a] = before[a]
        shorten_bristles(pad, found)
    return found


@compiled
def store_state(pad: Pad, delta: Vector, h: float, level: float) -> None:
    """Store bristle state, slip speed and wrench after a scaled slip displacement."""
    force, _, _, trial, shortening, _ = friction_and_jacobian(pad, delta, h, level)
    for a in range(3):
        pad.z[a] = shortening * trial[a]
    rate = 1.0 / h
    speed = math.sqrt(delta[0] * delta[0] + delta[1] * delta[1] + delta[2] * delta[2]) * rate
    between, pad.half_step = pad.half_step + 0.5 * h, 0.5 * h
    if shortening < 1.0:
        pad.slip_rate = (speed - pad.slip_speed) / between
        pad.slip_speed = speed
    else:
        pad.slip_rate = 0.0
        pad.slip_speed = min(speed, pad.slip_speed)
    pad.wrench[0], pad.wrench[1], pad.wrench[2] = -force[0], -force[1], -pad.radius * force[2]


@compiled
def detach(pad: Pad, slip_speed: float) -> None:
    """Reset the bristles of a pad that carries no normal force."""
    pad.z[:] = 0.0
    pad.wrench[:] = 0.0
    pad.slip_speed = slip_speed
    pad.slip_rate = 0.0
