"""The friction step: elasto-plastic return mapping onto an ellipsoidal limit surface.

Each pad carries three bristle deflections z in the scaled displacement
(x, y, r theta) at its centre of pressure. Friction per normal force is

    f / f_n = sigma_0 z + sigma_1 dz/dt + sigma_2 u,        |z| <= g(v) / sigma_0,

with u the scaled slip twist and g(v) the Stribeck curve of the slip speed v: |u|
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
which a semi-smooth Newton iteration finds. If its speed says another g, as in a
break-away, where slip grows within a sub-step, that one is fixed and the problem solved
once more.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled
from slipgym.contact.decay import decay

LEVEL_TOLERANCE = 1e-3  # of the friction level, between what was expected and what was found


@compiled
def level(mu_c, mu_s, share):
    """Friction level g = mu_c + (mu_s - mu_c) share [-], the share being exp(-(v / v_s)^gamma)."""
    return mu_c + (mu_s - mu_c) * share


@compiled
def stribeck(pad, slip_speed):
    """Friction level g(v) with power = (v / v_s)^gamma [-]."""
    ratio = slip_speed / pad.stribeck_velocity
    power = ratio * ratio if pad.stribeck_exponent == 2.0 else ratio**pad.stribeck_exponent
    return level(pad.mu_c, pad.mu_s, decay(power))


@compiled
def friction_level(pad, h):
    """Friction level g at the slip speed expected in the middle of a sub-step of h [-]."""
    return stribeck(pad, expected_speed(pad, h))


@compiled
def expected_speed(pad, h):
    """Slip speed expected in the middle of a sub-step of h [m/s]."""
    return max(0.0, pad.slip_speed + (pad.half_step + 0.5 * h) * pad.slip_rate)


@compiled
def near(pad, speed_change):
    """Whether a change of slip speed hardly changes the friction level, a curve of slope below 1 / v_s."""
    return (pad.mu_s - pad.mu_c) * abs(speed_change) <= LEVEL_TOLERANCE * pad.mu_c * pad.stribeck_velocity


@compiled
def kept(z, reach):
    """Share of its deflection that a bristle keeps within a reach that may have become shorter [-]."""
    squared = z[0] * z[0] + z[1] * z[1] + z[2] * z[2]
    return reach / math.sqrt(squared) if squared > reach * reach else 1.0


@compiled
def respond(pad, z, normal, delta, h, reach):
    """Friction of one bristle after a scaled slip displacement over time h.

    Args:
        pad: PAD record with the parameters.
        z: Deflection inside the ball of `reach`, scaled components, tuple of 3 [m].
        normal: Normal force that the bristle carries [N].
        delta: Scaled slip displacement (x, y, r theta) of the sub-step, tuple of 3 [m].
        h: Sub-step [s].
        reach: Longest deflection g / sigma_0 in this sub-step [m].

    Returns:
        force: Friction opposing `delta`, scaled components, tuple of 3 [N].
        isotropic, radial, direction: Derivative of `force` by `delta`, as
            isotropic I - radial direction direction^T [N/m].
        shortening: Factor of the return mapping on the trial deflection (1 = stick).
    """
    y = (z[0] + delta[0], z[1] + delta[1], z[2] + delta[2])
    squared = y[0] * y[0] + y[1] * y[1] + y[2] * y[2]
    rate = 1.0 / h
    damping = normal * pad.sigma_1 * rate
    elastic = normal * pad.sigma_0 + damping
    viscous = normal * pad.sigma_2 * rate
    shortening, radial = 1.0, 0.0
    if squared > reach * reach:
        per_length = 1.0 / math.sqrt(squared)
        shortening = reach * per_length
        radial = elastic * shortening * per_length * per_length
    spring = elastic * shortening
    force = (
        spring * y[0] - damping * z[0] + viscous * delta[0],
        spring * y[1] - damping * z[1] + viscous * delta[1],
        spring * y[2] - damping * z[2] + viscous * delta[2],
    )
    return force, spring + viscous, radial, y, shortening


@compiled
def prepare(pad, h):
    """Fix the friction level of a sub-step and bring the bristles into it; returns the level [-]."""
    limit = friction_level(pad, h)
    bring_in(pad, limit)
    return limit


@compiled
def bring_in(pad, limit):
    """Bring the bristles into a friction level."""
    share = kept((pad.z[0], pad.z[1], pad.z[2]), limit / pad.sigma_0)
    if share < 1.0:  # a product with 1 would have stick wait for root and quotient, a fifth of a sub-step
        for a in range(3):
            pad.z[a] *= share


@compiled
def revise(pad, before, delta, h, limit):
    """Fix the level anew that the slip speed of a sub-step turns out to mean, if it is another.

    Args:
        pad: PAD record.
        before: Bristles at the start of the sub-step, tuple of 3 [m].
        delta: Scaled slip displacement under `limit`, tuple of 3 [m].
        h: Sub-step [s].
        limit: The level so far [-].

    Returns:
        The level; `limit` if it is near.
    """
    expected = expected_speed(pad, h)
    x, y, t = pad.z[0] + delta[0], pad.z[1] + delta[1], pad.z[2] + delta[2]
    reach = limit / pad.sigma_0
    stuck = x * x + y * y + t * t <= reach * reach
    if stuck and near(pad, max(expected, pad.slip_speed)):
        return limit
    speed = math.sqrt(delta[0] * delta[0] + delta[1] * delta[1] + delta[2] * delta[2]) * (1.0 / h)
    if stuck:
        speed = min(speed, pad.slip_speed)
    if near(pad, speed - expected):
        return limit
    found = stribeck(pad, speed)
    if abs(found - limit) <= LEVEL_TOLERANCE * limit:
        return limit
    for a in range(3):
        pad.z[a] = before[a]
    bring_in(pad, found)
    return found


@compiled
def commit(pad, delta, h, limit):
    """Store bristle state, slip speed and wrench after a scaled slip displacement."""
    z = (pad.z[0], pad.z[1], pad.z[2])
    force, _, _, trial, shortening = respond(pad, z, pad.normal, delta, h, limit / pad.sigma_0)
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
    pad.wrench[0], pad.wrench[1], pad.wrench[2] = -force[0], -force[1], -pad.r * force[2]


@compiled
def release(pad, slip_speed):
    """Forget the bristle state of a pad without normal force."""
    pad.z[:] = 0.0
    pad.wrench[:] = 0.0
    pad.slip_speed = slip_speed
    pad.slip_rate = 0.0


@compiled
def prescribed_step(pad, twist, h):
    """Advance one pad by a prescribed slip twist (v_x, v_y, omega) at its centre of pressure."""
    delta = (h * twist[0], h * twist[1], h * pad.r * twist[2])
    commit(pad, delta, h, prepare(pad, h))
