"""Scripts a carry: the wrist moves along a plan of minimum-jerk moves; what grip the plan takes.

A minimum-jerk move covers its way d in its duration T with the velocity 30 s^2 (1 - s)^2 d / T, s = t / T
(Flash and Hogan, J. Neurosci. 5(7), 1985). Its largest acceleration is 10 / sqrt(3) d / T^2, its largest
velocity 15 / 8 d / T.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled, compiled_call
from slipgym.tasks.disturbance import friction_factor, load
from slipgym.tasks.episode import drive_wrist, slip_distance
from slipgym.tasks.least_grip import least_under, load_at_rest, swing, torsional_stiffness
from slipgym.tasks.task import Column, term
from slipgym.world.actuator import mean_force
from slipgym.world.records import WORLD

ACCELERATION = 10.0 / math.sqrt(3.0)
"""Largest acceleration of a minimum-jerk move, times T^2 / d."""
VELOCITY = 15.0 / 8.0
"""Largest velocity of it, times T / d."""

PAUSE = 0.15
"""Rest between lift-off and the first move [s]."""


def move_time(way: float, acceleration: float, speed: float) -> float:
    """Least duration of a minimum-jerk move within an acceleration and a speed [s].

    Args:
        way: Length [m or rad].
        acceleration: Largest acceleration, > 0 [m/s^2 or rad/s^2].
        speed: Largest velocity, > 0 [m/s or rad/s].
    """
    return max(math.sqrt(ACCELERATION * abs(way) / acceleration), VELOCITY * abs(way) / speed)


@compiled
def planned_velocity(episode, time):
    """Velocity (x, z, pitch) of the planned moves at a time since reset [m/s, m/s, rad/s]."""
    x, z, pitch = 0.0, 0.0, 0.0
    for k in range(episode.moves.shape[0]):
        start, duration = episode.moves[k, 0], episode.moves[k, 1]
        if start < time < start + duration:
            s = (time - start) / duration
            rate = 30.0 * s * s * (1.0 - s) * (1.0 - s) / duration
            x += rate * episode.moves[k, 2]
            z += rate * episode.moves[k, 3]
            pitch += rate * episode.moves[k, 4]
    return x, z, pitch


@compiled
def planned_acceleration(episode, ahead, axis):
    """Acceleration of the planned moves along an axis in the control step that begins `ahead` from now.

    Args:
        episode: EPISODE record.
        ahead: Time from now [s].
        axis: 0, 1 or 2: x, z or pitch.
    """
    time, dt = episode.step * episode.step_time + ahead, episode.step_time
    return (planned_velocity(episode, time + dt)[axis] - planned_velocity(episode, time)[axis]) / dt


@compiled
def wrist_velocity(episode, world):
    """Scripted velocity of the wrist at the end of the coming control step."""
    return planned_velocity(episode, (episode.step + 1) * episode.step_time)


_REPETITIONS = 2
"""Rehearsals with swing, on soft pads."""


@compiled_call
def rehearse_at(episode, world, grip):
    """Least grip that keeps both pads stuck through the episode, if the object swings as in a given grip.

    The object is moved along with the wrist, as if it never slipped, under the scripted motion, oscillations,
    support, pushes, and changes of mass and friction; see `least_under`.

    Args:
        episode: EPISODE record at step 0, with mu_s and r; its step is 0 again afterwards.
        world: WORLD record; it is not changed.
        grip: Normal force of either pad in which it swings; 0: it does not [N].

    Returns:
        Largest and mean least grip [N], where the mean counts each step with at least the gripper's smallest
        force, and the largest acceleration of the wrist less gravity [m/s^2].
    """
    worlds = np.empty(1, WORLD)
    worlds[0] = world
    plan = worlds[0]
    dt, peak, total, fastest = episode.step_time, 0.0, 0.0, 0.0
    angle, rate, stiffness = 0.0, 0.0, torsional_stiffness(episode, grip) if grip > 0.0 else 0.0
    for step in range(episode.steps):
        episode.step = step
        load(episode, plan)
        velocity = wrist_velocity(episode, plan)
        drive_wrist(episode, plan, velocity[0], velocity[1], velocity[2])
        for a in range(3):  # the object goes with the wrist, whose velocity changes linearly in the step
            plan.wrist_velocity[a] += 0.5 * dt * plan.wrist_acceleration[a]
            plan.wrist[a] += 0.5 * dt * plan.wrist_velocity[a]
        cos, sin = math.cos(plan.wrist[2]), math.sin(plan.wrist[2])
        x, z = plan.grasp_point[0], plan.grasp_point[1]
        plan.com[0] = plan.wrist[0] - cos * x + sin * z
        plan.com[1] = plan.wrist[1] - sin * x - cos * z
        f_x, f_y, torque = load_at_rest(episode, plan)
        if grip > 0.0:
            torque, angle, rate = swing(episode, plan, torque, stiffness, angle, rate)
        need = least_under(episode, (f_x, f_y, torque), friction_factor(episode, plan))
        peak, total = max(peak, need), total + max(need, episode.force_min)
        along = math.hypot(plan.wrist_acceleration[0], plan.wrist_acceleration[1] + plan.gravity)
        fastest = max(fastest, along)
        for a in range(3):
            plan.wrist[a] += 0.5 * dt * plan.wrist_velocity[a]
            plan.wrist_velocity[a] += 0.5 * dt * plan.wrist_acceleration[a]
    episode.step = 0
    return peak, total / episode.steps, fastest


@compiled
def rehearse(episode, world):
    """Least grip that keeps both pads stuck through the episode, as far as its start determines it.

    On soft pads the object swings, by how much depends on the grip: the grip is found by repetition, from
    that without swing on.

    Args:
        episode: As in `rehearse_at`.
        world: Likewise.

    Returns:
        As `rehearse_at`.
    """
    found = rehearse_at(episode, world, 0.0)
    if episode.compliance > 0.0:
        for _ in range(_REPETITIONS):
            found = rehearse_at(episode, world, max(found[0], episode.force_min))
    return found


@compiled
def spend(episode, fingers):
    """Add the grip of this control step, once, to the sum over the steps so far.

    Args:
        episode: EPISODE record.
        fingers: FINGER (2,).
    """
    if episode.step > episode.grip_counted:
        episode.grip_counted = episode.step
        episode.grip_sum += mean_force(fingers)


STILL_WIDTH = 0.015
"""Width of `still_wide` [m]."""


@term(scale=0.0)
def still_wide(episode, world, fingers):
    """exp(-(s / 15 mm)^2), the same s: it has a slope where `still` is 0."""
    return math.exp(-((slip_distance(world) / STILL_WIDTH) ** 2))


WRIST_COLUMNS = (
    Column(
        "wrist_velocity_x", -2.0, 2.0, "m/s", "commanded wrist velocity along world x",
        "world.wrist_velocity[0]",
    ),
    Column(
        "wrist_velocity_z", -2.0, 2.0, "m/s", "commanded wrist velocity along world z",
        "world.wrist_velocity[1]",
    ),
    Column(
        "wrist_pitch_rate", -10.0, 10.0, "rad/s", "commanded wrist pitch rate", "world.wrist_velocity[2]"
    ),
)  # fmt: skip
"""The wrist's velocity, of tasks whose wrist moves."""
