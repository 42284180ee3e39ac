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

_NEWTON, _CLOSE = 6, 1e-4
"""Most steps of Newton's method, and the relative change after which it ends."""


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
def least_under(episode, load, factor):
    """Least grip per finger that keeps both pads stuck under a load [N].

    Args:
        episode: EPISODE record.
        load: From `load_at_rest`.
        factor: Friction now over that at reset [-].
    """
    f_x, f_y, torque = load
    cops, radii, axes, arm = episode.cops, episode.radii, episode.axes, torsion_arm(episode)
    grip, slide, turn = 0.0, 0.0, 0.0
    for f in range(2):  # the pad that needs more at the reference force
        x, y = 0.5 * (cops[f, 0] - cops[1 - f, 0]), 0.5 * (cops[f, 1] - cops[1 - f, 1])
        own_x, own_y = 0.5 * f_x - y * (torque / arm), 0.5 * f_y + x * (torque / arm)
        friction = episode.finger_friction[f] * episode.mu_s * factor
        slides = (own_x / axes[0]) ** 2 + (own_y / axes[1]) ** 2
        turns = (torque * (radii[f] ** 2 / arm) / radii[f]) ** 2
        needed = math.sqrt(slides + turns) / friction
        if needed > grip:
            grip, slide, turn = needed, slides / friction**2, turns / friction**2
    if (episode.load_exponent == 0.0 and episode.radius_exponent == 0.0) or grip == 0.0:
        return grip
    for _ in range(_NEWTON):  # in the logarithm of the grip
        scale, r = at_load(episode, grip)
        turns = turn * (episode.r / min(r, episode.radius_max)) ** 2
        gap = math.log(math.sqrt(slide + turns) / (scale * grip))
        gap /= 1.0 - episode.load_exponent + episode.radius_exponent * turns / (slide + turns)
        grip *= math.exp(gap)
        if abs(gap) < _CLOSE:
            break
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
def swing(episode, world, torque, stiffness, angle, rate):
    """Let the object swing on the torsion of soft pads for a control step, by the implicit midpoint rule.

    Args:
        episode: EPISODE record.
        world: WORLD record.
        torque: Of `load_at_rest` [N m].
        stiffness: From `torsional_stiffness` [N m/rad].
        angle: Of the swing [rad].
        rate: Its rate [rad/s].

    Returns:
        Torque on the pads in the middle of the step, angle and rate at its end [N m, rad, rad/s].
    """
    dt, damping = episode.step_time, episode.shear_time * stiffness
    inertia = world.inertia + world.mass * (world.grasp_point[0] ** 2 + world.grasp_point[1] ** 2)
    drag, last = dt * (0.5 * damping + 0.25 * dt * stiffness) / inertia, rate
    rate = ((1.0 - drag) * last - dt * (stiffness * angle + torque) / inertia) / (1.0 + drag)
    mean = 0.5 * (last + rate)
    return -stiffness * (angle + 0.5 * dt * mean) - damping * mean, angle + dt * mean, rate
