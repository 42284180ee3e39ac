"""Defines EPISODE, the plain-array state of an episode that all tasks have in common."""

from __future__ import annotations

import math
from collections import namedtuple
from typing import Any

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.tasks.disturbance import FIELDS, shake_velocity
from slipgym.world.wrist import ramp_wrist

TERMS_MAX = 12
"""Largest number of reward terms of a task."""
MOVES_MAX = 8
"""Largest number of moves in a plan of the wrist."""
OWN_MAX = 8
"""Number of values that a task can keep besides the fields of all tasks."""


EPISODE = np.dtype(
    [
        ("step", "i8"),  # control steps since reset
        ("step_time", "f8"),  # length of a control step [s]
        ("steps", "i8"),  # length of the episode in control steps
        ("tolerance", "f8"),  # of success along the task's coordinate [m or rad]
        ("slide_tolerance", "f8"),  # largest slip at the pad centre for success [m]
        ("tilt_tolerance", "f8"),  # largest tilt for success [rad]
        ("wrist_start", "f8", 3),  # pad centre (x, z) and pitch at reset [m, m, rad]
        ("wrist_roll", "f8"),  # roll of the wrist at reset [rad]
        ("reach", "f8", 2),  # pad centre may lie this far from the object's centre, (x, z) [m]
        ("object_centre", "f8", 2),  # geometric centre from the grasp point, body frame [m]
        ("pad_radius", "f8"),  # radius of a pad [m]
        ("force_min", "f8"),  # lower end of the force action [N]
        ("force_max", "f8"),  # upper end of the force action [N]
        ("wrist_speed_max", "f8"),  # largest speed of the gripper [m/s]
        ("wrist_pitch_rate_max", "f8"),  # largest pitch rate of the gripper [rad/s]
        ("command", "f8"),  # grip force commanded now [N]
        ("last_command", "f8"),  # grip force commanded before [N]
        ("wrist_command", "f8", 3),  # wrist velocity that the agent commands now [m/s, m/s, rad/s]
        ("reference", "f8", 3),  # position, velocity, acceleration of the task's coordinate [m or rad, s]
        ("terms", "f8", TERMS_MAX),  # reward terms of the last step, scaled [-]
        ("scales", "f8", TERMS_MAX),  # of the reward terms [-]
        ("success", "?"),  # whether the episode has ended as a success
        ("dropped", "?"),  # whether the object is lost
        ("violated", "?"),  # whether success has become impossible; it stays true
        ("just_violated", "?"),  # whether it became impossible in the last step
        ("ended", "?"),  # whether the task ended the episode before its length
        ("end_at_violation", "?"),  # whether a violation ends it
        ("guesses", "?"),  # whether the agent states friction itself
        ("guess", "f8", 6),  # mu_s, mu_c [-], r [m], their relative deviations: the agent's or the estimate
        ("largest_slip", "f8"),  # of the pad centre since reset [m]
        ("largest_tilt", "f8"),  # of the object against its start since reset [rad]
        # tasks that limit the grip
        ("least_grip", "f8"),  # that holds the object through the episode, 0: the task has none [N]
        ("least_grip_now", "f8"),  # that holds it under the present load [N]
        ("grip_limit", "f8"),  # force at which it breaks, or mean grip allowed [N]
        ("grip_budget", "f8"),  # largest sum of the grip over the control steps that count, 0: any [N]
        ("grip_sum", "f8"),  # that sum so far [N]
        ("grip_counted", "i8"),  # control step up to which the sum goes
        # tasks with a reference
        ("goal", "f8"),  # where the reference ends [m or rad]
        ("duration", "f8"),  # of the motion [s]
        ("settle", "f8"),  # before the motion [s]
        # tasks with a support and a planned motion of the wrist
        ("support", "f8", 4),  # times: lift-off begins and ends, touch-down begins and ends [s]
        ("moves", "f8", (MOVES_MAX, 5)),  # start, duration [s], and way in x, z, pitch [m, m, rad]
        ("own", "f8", OWN_MAX),  # what else a task keeps, named by `scratch`; zero before its start [its own]
        *FIELDS,
    ],
    align=True,
)
"""One episode: clock, reference, reward terms, outcome and the tasks' own parameters."""


def scratch(**sizes: int) -> Any:
    """Names for the numbers of `episode.own`, in which a task keeps its own state.

    `SCRATCH = scratch(target=3, rest_speed=1)` gives `SCRATCH.target`, the slice of the first three numbers,
    and `SCRATCH.rest_speed`, the index of the fourth; both work in Python and in compiled functions:
    `episode.own[SCRATCH.rest_speed]`. All numbers are zero before the task's `start`.

    Args:
        **sizes: Name -> how many numbers.

    Raises:
        ValueError: A size is below 1, or there are more than `OWN_MAX` numbers.
    """
    if min(sizes.values(), default=1) < 1 or sum(sizes.values()) > OWN_MAX:
        raise ValueError(f"scratch sizes {sizes} must be at least 1 each and {OWN_MAX} together at most")
    places, end = {}, 0
    for name, size in sizes.items():
        places[name] = end if size == 1 else slice(end, end + size)
        end += size
    return namedtuple("Scratch", places)(**places)


def schedule(settings: Any, episode: np.void) -> None:
    """Fill in settle, duration and length, from settings with `settle`, `duration` and `hold` [s]."""
    episode["settle"], episode["duration"] = settings.settle, settings.duration
    total = settings.settle + settings.duration + settings.hold
    episode["steps"] = max(1, round(total / episode["step_time"].item()))


@compiled
def whole_steps(time, dt):
    """A time in control steps of length dt, the nearest whole number."""
    return np.int64(np.rint(time / dt))


@compiled
def between(ends, share):
    """The number that lies a share in [0, 1) of the way between two ends."""
    return ends[0] + (ends[1] - ends[0]) * share


@compiled
def begin_step(episodes, commands):
    """Take the commands of the coming control step, (n, 4): grip force and wrist velocity (x, z, pitch)."""
    for i in range(episodes.shape[0]):
        episode = episodes[i]
        episode.last_command = episode.command
        episode.command = commands[i, 0]
        for a in range(3):
            episode.wrist_command[a] = commands[i, 1 + a]


@compiled
def drive_wrist(episode, world, x, z, pitch):
    """Bring the wrist to the sum of scripted velocity, oscillation and the agent's command in a step.

    `x` and `z` are the scripted velocity in the world at the end of the step [m/s], `pitch` its pitch rate
    [rad/s]. The gripper's limits apply to the sum.
    """
    time = (episode.step + 1) * episode.step_time
    x += shake_velocity(episode, 0, time) + episode.wrist_command[0]
    z += shake_velocity(episode, 1, time) + episode.wrist_command[1]
    pitch += shake_velocity(episode, 2, time) + episode.wrist_command[2]
    limits = episode.wrist_speed_max, episode.wrist_pitch_rate_max
    ramp_wrist(world, x, z, pitch, limits[0], limits[1], episode.step_time)


@compiled
def detect_drop(episode, world, fingers):
    """Whether the object left the pads: no contact, or the pad reaches over an edge."""
    x = episode.object_centre[0]
    z = episode.object_centre[1]
    cos, sin = np.cos(world.slip[2]), np.sin(world.slip[2])
    # geometric centre in the pad frame, then the pad centre in the body frame
    cx = world.slip[0] + cos * x - sin * z
    cz = world.slip[1] + sin * x + cos * z
    bx, bz = -(cos * cx + sin * cz), -(-sin * cx + cos * cz)
    outside = abs(bx) > episode.reach[0] or abs(bz) > episode.reach[1]
    lost = fingers[0].contact_force <= 0.0 and fingers[1].contact_force <= 0.0
    return outside or lost


@compiled
def limited(value):
    """A number limited to [-1, 1]; NaN stays NaN."""
    if value > 1.0:
        return 1.0
    if value < -1.0:
        return -1.0
    return value


@compiled
def slip_distance(world):
    """Distance of the object from the grasp at the pad centre [m]."""
    return math.hypot(world.slip[0], world.slip[1])


@compiled
def track_slip(episode, world):
    """Keep the largest slip at the pad centre."""
    episode.largest_slip = max(episode.largest_slip, slip_distance(world))


@compiled
def trapezoid(t, distance, duration):
    """Trapezoidal reference: a fifth of the time to speed up, a fifth to slow down.

    Args:
        t: Time since the motion's start [s]; before 0 and after `duration` it rests.
        distance: Path length [m] or angle [rad].
        duration: Time for it [s].

    Returns:
        Position, velocity and acceleration.
    """
    rise = 0.2 * duration
    cruise = distance / (duration - rise)
    acceleration = cruise / rise
    if t <= 0.0:
        return 0.0, 0.0, 0.0
    if t < rise:
        return 0.5 * acceleration * t * t, acceleration * t, acceleration
    if t < duration - rise:
        return cruise * (t - 0.5 * rise), cruise, 0.0
    if t < duration:
        left = duration - t
        return distance - 0.5 * acceleration * left * left, acceleration * left, -acceleration
    return distance, 0.0, 0.0


@compiled
def follow_trapezoid(episode):
    """Write the present trapezoidal reference, which reaches `goal` within `duration` after `settle`."""
    time = episode.step * episode.step_time
    reference = trapezoid(time - episode.settle, episode.goal, episode.duration)
    for k in range(3):
        episode.reference[k] = reference[k]
