"""Stores an episode's disturbances, and applies them to object, wrist and friction.

`episode` is an EPISODE record, `world` a WORLD record; `episodes`, `worlds` (n,) and `pads` PAD (n, 2) are
those of n environments.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled
from slipgym.contact.soft_pad import present_friction
from slipgym.world.wrist import ramp_tilt

SHAKES = 2
"""Number of wrist oscillations that add up: the task's own and a sampled one."""
POKES_MAX = 64
"""Largest number of pushes of a task."""
PUSHES_MAX = POKES_MAX + 16
"""Largest number of pushes of a task and its randomization together."""
_SHAKE_RISE = 0.5  # [s] over which a shaking builds up, so that it starts without a jerk
_LEAST, _MOST = 0.2, 5.0  # drift takes friction no further than this, over the drawn one

FIELDS = [
    ("shakes", "f8", (SHAKES, 3, 3)),  # per axis: amplitude [m, rad], omega [rad/s], phase [rad]
    ("tilt_shakes", "f8", (2, 3)),  # the same in roll and along the grip axis [m, rad], [rad/s], [rad]
    ("mass", "f8"),  # of the object at reset [kg]
    ("inertia", "f8"),  # of the object at reset [kg m^2]
    ("mass_step", "i8"),  # control step at which mass and inertia change
    ("mass_factor", "f8"),  # mass after over before it [-]
    ("mu_s", "f8"),  # static friction at reset, mean of both pads [-]
    ("mu_c", "f8"),  # Coulomb friction, likewise [-]
    ("r", "f8"),  # radius of the equivalent rim contact, likewise [m]
    ("finger_friction", "f8", 2),  # friction of either pad over the mean [-]
    ("present_friction", "f8", (2, 3)),  # mu_s, mu_c [-] and r [m] of each finger now
    # as in PAD, `soft_pad.at_load` reads the first three
    ("reference_force", "f8"),  # normal force at which mu_s, mu_c and r hold [N]
    ("load_exponent", "f8"),  # friction falls with the normal force to the power of this [-]
    ("radius_exponent", "f8"),  # r grows with it to the power of this [-]
    ("radius_max", "f8"),  # largest r [m]
    ("compliance", "f8"),  # tangential compliance of the rubber [m/N]
    ("shear_time", "f8"),  # damping of the rubber over its stiffness [s]
    ("axes", "f8", 2),  # friction along the pad's x and y over its mean [-]
    ("cops", "f8", (2, 2)),  # centre of pressure of either pad, pad frame [m]
    ("radii", "f8", 2),  # r of either pad [m]
    ("drift", "f8"),  # relative rate of friction [1/s]
    ("jump_step", "i8"),  # control step at which friction changes
    ("jump_factor", "f8"),  # friction after over before it [-]
    ("region", "f8", 2),  # distance from the grasp at which another surface begins and ends [m]
    ("region_factor", "f8"),  # friction on it over elsewhere [-]
    ("pushes", "i8"),  # how many pushes
    # last, as they are long and most steps have no push
    ("push_start", "i8", PUSHES_MAX),  # control step at which a push begins
    ("push_end", "i8", PUSHES_MAX),  # first control step without it
    ("push_wrench", "f8", (PUSHES_MAX, 3)),  # on the centre of mass, world [N, N, N m]
]
"""Fields of EPISODE."""


@compiled
def shake_velocity(episode, axis, time):
    """Wrist velocity of the oscillations along axis 0, 1 or 2 (x, z, pitch) at a time since reset [s].

    They rise smoothly from rest.
    """
    total = 0.0
    for k in range(episode.shakes.shape[0]):
        amplitude, omega, phase = episode.shakes[k, axis]
        if amplitude == 0.0:
            continue
        speed = amplitude * omega * math.cos(omega * time + phase)
        if time < _SHAKE_RISE:
            speed *= 0.5 - 0.5 * math.cos(math.pi * time / _SHAKE_RISE)
        total += speed
    return total


@compiled
def shake_tilt(episodes, tilts):
    """Before a control step, ramp the wrist's roll and its motion along the grip axis, in TILT (n,).

    The gripper's limits of pitch rate and speed apply.
    """
    for i in range(episodes.shape[0]):
        episode = episodes[i]
        time = (episode.step + 1) * episode.step_time
        rise = 0.5 - 0.5 * math.cos(math.pi * min(time / _SHAKE_RISE, 1.0))
        (a, rate_a, phase_a), (b, rate_b, phase_b) = episode.tilt_shakes[0], episode.tilt_shakes[1]
        roll = rise * a * rate_a * math.cos(rate_a * time + phase_a)
        sway = rise * b * rate_b * math.cos(rate_b * time + phase_b)
        limits = episode.wrist_pitch_rate_max, episode.wrist_speed_max
        ramp_tilt(tilts[i], roll, sway, limits[0], limits[1], episode.step_time)


@compiled
def friction_factor(episode, world):
    """Friction now over that at reset [-]: drift, jump, and the surface region under the pads."""
    factor = 1.0
    if episode.drift != 0.0:
        factor = min(max(math.exp(episode.drift * episode.step * episode.step_time), _LEAST), _MOST)
    if episode.step >= episode.jump_step:
        factor *= episode.jump_factor
    region = episode.region
    uneven = episode.region_factor != 1.0
    if uneven and region[0] <= math.hypot(world.slip[0], world.slip[1]) < region[1]:
        factor *= episode.region_factor
    return factor


@compiled
def support_share(episode):
    """Share of the weight that a support below the object bears [-]; 0 in tasks without one.

    It falls from 1 to 0 linearly at lift-off, and rises again at touch-down.
    """
    time, times = episode.step * episode.step_time, episode.support
    lifting = (times[1] - time) / max(times[1] - times[0], 1e-9)
    landing = (time - times[2]) / max(times[3] - times[2], 1e-9) if times[3] > 0.0 else 0.0
    return min(max(lifting, landing, 0.0), 1.0)


@compiled
def bear(episode, world):
    """Add the support's force to the load on the object, at its centre of mass."""
    if episode.support[1] > 0.0:
        world.external[1] += support_share(episode) * world.mass * world.gravity


@compiled
def bear_all(episodes, worlds):
    """`bear` for n environments."""
    for i in range(episodes.shape[0]):
        bear(episodes[i], worlds[i])


@compiled
def add_push(episode, begin, steps, impulse, heading, lever):
    """Add a push to an episode.

    Args:
        episode: EPISODE record.
        begin: Control step at which it begins.
        steps: Control steps that it lasts.
        impulse: Force times duration [N s].
        heading: Angle of the force to world x, towards up [rad].
        lever: Of the force about the centre of mass [m].
    """
    k, force = episode.pushes, impulse / (steps * episode.step_time)
    episode.push_start[k], episode.push_end[k] = begin, begin + steps
    episode.push_wrench[k, 0] = force * math.cos(heading)
    episode.push_wrench[k, 1] = force * math.sin(heading)
    episode.push_wrench[k, 2] = force * lever
    episode.pushes = k + 1


@compiled
def load(episode, world):
    """Set the load on the object and its mass at the episode's step: support, pushes, change of mass."""
    world.external[:] = 0.0
    for k in range(episode.pushes):  # if pushes overlap, the last one in the list acts
        if episode.push_start[k] <= episode.step < episode.push_end[k]:
            for a in range(3):
                world.external[a] = episode.push_wrench[k, a]
    heavier = episode.mass_factor if episode.step >= episode.mass_step else 1.0
    world.mass, world.inertia = heavier * episode.mass, heavier * episode.inertia
    bear(episode, world)


@compiled
def disturb(episodes, worlds, pads, friction):
    """Before a control step, set the load on the object, its mass, and the friction.

    `friction` is output, (n, 3): mu_s, mu_c and r now, mean of both pads; r as it is unless a pad is soft.
    """
    for i in range(episodes.shape[0]):
        episode, world = episodes[i], worlds[i]
        load(episode, world)
        factor = friction_factor(episode, world)
        for f in range(2):
            own = factor * episode.finger_friction[f]
            pads[i, f].mu_s, pads[i, f].mu_c = own * episode.mu_s, own * episode.mu_c
            mu_s, mu_c, r = present_friction(pads[i, f])
            episode.present_friction[f, 0], episode.present_friction[f, 1] = mu_s, mu_c
            if pads[i, f].radius_exponent != 0.0:
                episode.present_friction[f, 2] = r
        for k in range(3):
            friction[i, k] = 0.5 * (episode.present_friction[0, k] + episode.present_friction[1, k])
