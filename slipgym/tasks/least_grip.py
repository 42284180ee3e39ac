"""Computes the least grip with which both pads stick, rigid or soft, under a load.

A pad sticks within the ellipsoidal limit surface, (f_x / a_x)^2 + (f_y / a_y)^2 + (tau / r)^2 <=
(mu_s f_n)^2, with the friction along its axes over their mean, a. On a soft pad mu_s and r depend on f_n.
Both pads are equally stiff, k in translation and k r^2 in torsion about their centres of pressure, and share
the load accordingly. Growth of mu_s with the dwell time does not count.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled
from slipgym.contact.soft_pad import at_load
from slipgym.tasks.disturbance import friction_factor
from slipgym.world.object_motion import wrench_at_rest

_NEWTON, _CLOSE = 6, 3e-3
"""Most steps of Newton's method, and the relative change after which it ends: 1e-6 of it is left."""


@compiled
def load_at_rest(episode, world):
    """Load that keeps the object at rest on the pads: f_x, f_y, tau about their mean centre [N, N, N m]."""
    f_x, f_y, torque = wrench_at_rest(world)
    cops = episode.cops
    torque -= 0.5 * ((cops[0, 0] + cops[1, 0]) * f_y - (cops[0, 1] + cops[1, 1]) * f_x)
    return f_x, f_y, torque


@compiled
def torsion_arm(episode):
    """Torsional over translational stiffness of a pad, summed over both, with their levers [m^2]."""
    cops, radii = episode.cops, episode.radii
    x, y = cops[0, 0] - cops[1, 0], cops[0, 1] - cops[1, 1]
    return radii[0] ** 2 + radii[1] ** 2 + 0.5 * (x * x + y * y)


@compiled
def bearing(episode):
    """Numbers of both pads that `demand` needs: a loop over loads then computes several at once."""
    cops, radii, axes, arm = episode.cops, episode.radii, episode.axes, torsion_arm(episode)
    x, y = 0.5 * (cops[0, 0] - cops[1, 0]), 0.5 * (cops[0, 1] - cops[1, 1])
    mu_s, friction = episode.mu_s, episode.finger_friction
    first = x, y, friction[0] * mu_s, radii[0] ** 2 / arm, radii[0]
    return arm, (axes[0], axes[1]), first, (-x, -y, friction[1] * mu_s, radii[1] ** 2 / arm, radii[1])


@compiled
def demand(pads, load, factor):
    """Least grip under a load at the friction and r of the reference force [N], and the torque's share in it.

    Args:
        pads: From `bearing`.
        load: From `load_at_rest`.
        factor: Friction now over that at reset [-].

    Returns:
        The grip, of the pad that needs more, and w = (tau / r)^2 over the square of its load [-].
    """
    f_x, f_y, torque = load
    arm, axes, first, second = pads
    grip, turning, twist = 0.0, 0.0, torque / arm
    for x, y, mu_s, share, r in (first, second):
        own_x, own_y = 0.5 * f_x - y * twist, 0.5 * f_y + x * twist
        turns = (torque * share / r) ** 2
        square = (own_x / axes[0]) ** 2 + (own_y / axes[1]) ** 2 + turns
        needed = math.sqrt(square) / (mu_s * factor)
        turning = turns / square if needed > grip else turning
        grip = needed if needed > grip else grip
    return grip, turning


@compiled
def varies(episode):
    """Whether friction or r depend on the grip."""
    return episode.load_exponent != 0.0 or episode.radius_exponent != 0.0


@compiled
def square_at(needed, turning, c):
    """Square of what a load needs, where (r / r(f_n))^2 is c: mu_s(f_n) / mu_s f_n must reach it [N^2]."""
    return needed * needed * (1.0 - turning + turning * c)


@compiled
def on_soft_pads(episode, needed, turning, guess):
    """Least grip where friction and r are those at this grip.

    With f_0 the reference force, x = ln(f_n / f_0) and c = (r / r(f_n))^2 it solves
    (1 - load_exponent) x = ln(needed / f_0) + ln(1 - w + w c) / 2 by Newton's method.

    Args:
        episode: EPISODE record.
        needed: From `demand`, > 0 [N].
        turning: From `demand`, w.
        guess: Of x.

    Returns:
        The grip [N], x and c.
    """
    a, b, x = 1.0 - episode.load_exponent, episode.radius_exponent, guess
    wanted, least = math.log(needed / episode.reference_force), (episode.r / episode.radius_max) ** 2
    c = 1.0
    for _ in range(_NEWTON):
        grows, c = b, math.exp(-2.0 * b * x)
        if c < least:
            grows, c = 0.0, least
        square = 1.0 - turning + turning * c
        gap = (wanted + 0.5 * math.log(square) - a * x) / (a + grows * turning * c / square)
        x += gap
        if abs(gap) < _CLOSE:
            break
    return episode.reference_force * math.exp(x), x, c


@compiled
def least_under(episode, load, factor):
    """Least grip per finger that keeps both pads stuck under a load [N], see `demand`."""
    grip, turning = demand(bearing(episode), load, factor)
    if varies(episode) and grip > 0.0:
        guess = math.log(grip / episode.reference_force)
        grip, _, _ = on_soft_pads(episode, grip, turning, guess)
    return grip


@compiled
def least_grip(episode, world):
    """Least grip per finger that keeps both pads stuck under the present load, without swing [N]."""
    return least_under(episode, load_at_rest(episode, world), friction_factor(episode, world))


@compiled
def torsional_stiffness(episode, grip):
    """Stiffness of two soft pads against a turn of the object, in a grip [N m/rad]."""
    growth = at_load(episode, grip)[1] / episode.r
    return torsion_arm(episode) / episode.compliance * growth**2


@compiled
def swing(episode, inertia, torque, stiffness, angle, rate):
    """Let the object swing on the torsion of soft pads for a control step, by the implicit midpoint rule.

    Args:
        episode: EPISODE record.
        inertia: Of the object about the pads [kg m^2].
        torque: Of `load_at_rest` [N m].
        stiffness: From `torsional_stiffness` [N m/rad].
        angle: Of the swing [rad].
        rate: Its rate [rad/s].

    Returns:
        Torque on the pads in the middle of the step, angle and rate at its end [N m, rad, rad/s].
    """
    dt, damping = episode.step_time, episode.shear_time * stiffness
    drag, last = dt * (0.5 * damping + 0.25 * dt * stiffness), rate
    rate = ((inertia - drag) * last - dt * (stiffness * angle + torque)) / (inertia + drag)
    mean = 0.5 * (last + rate)
    return -stiffness * (angle + 0.5 * dt * mean) - damping * mean, angle + dt * mean, rate
