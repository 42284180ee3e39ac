"""Scripts a carry: the wrist moves along a plan of minimum-jerk moves; what grip the plan takes.

A minimum-jerk move covers its way d in its duration T with the velocity 30 s^2 (1 - s)^2 d / T, s = t / T
(Flash and Hogan, J. Neurosci. 5(7), 1985). Its largest acceleration is 10 / sqrt(3) d / T^2, its largest
velocity 15 / 8 d / T.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from slipgym._numba.compiled import compiled, compiled_call
from slipgym.tasks.disturbance import friction_factor, load
from slipgym.tasks.episode import drive_wrist, slip_distance
from slipgym.tasks.least_grip import (
    bearing,
    demand,
    load_at_rest,
    on_soft_pads,
    square_at,
    swing,
    torsional_stiffness,
    varies,
)
from slipgym.tasks.task import Column, term
from slipgym.world.actuator import mean_force
from slipgym.world.object_motion import pad_axes
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


def write_moves(
    episode: np.void, time: float, moves: Sequence[tuple[float, tuple[float, float, float]]], speed: float
) -> float:
    """Plan moves of the wrist one after the other.

    Args:
        episode: EPISODE record.
        time: Start of the first one [s].
        moves: Largest acceleration of each [m/s^2], and its way in x, z and pitch [m, m, rad].
        speed: Largest velocity [m/s].

    Returns:
        End of the last one [s].
    """
    plan = []
    for acceleration, way in moves:
        plan.append((time, move_time(math.hypot(way[0], way[1]), acceleration, speed), *way))
        time += plan[-1][1]
    episode["moves"][: len(plan)] = plan
    return time


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
    """Acceleration of the planned moves in the control step that begins a time ahead of now [s].

    `axis` is 0, 1 or 2: x, z or pitch.
    """
    time, dt = episode.step * episode.step_time + ahead, episode.step_time
    return (planned_velocity(episode, time + dt)[axis] - planned_velocity(episode, time)[axis]) / dt


@compiled
def wrist_velocity(episode, world):
    """Scripted velocity of the wrist at the end of the coming control step."""
    return planned_velocity(episode, (episode.step + 1) * episode.step_time)


_REPETITIONS = 2
"""Rehearsals with swing, on soft pads."""
_ROWS = 5
"""What a rehearsal keeps of every step, see `plan_loads`."""


@compiled_call
def plan_loads(episode, world, loads):
    """Loads on the pads in every step of the episode.

    The object is moved along with the wrist, as if it never slipped, under the scripted motion, oscillations,
    support, pushes, and changes of mass and friction.

    Args:
        episode: EPISODE record at step 0; its step is 0 again afterwards.
        world: WORLD record; it is not changed.
        loads: Output (_ROWS, steps): load as from `load_at_rest`, friction over that at reset [-], inertia of
            the object about the pads [kg m^2].

    Returns:
        Largest acceleration of the wrist less gravity [m/s^2].
    """
    worlds = np.empty(1, WORLD)
    worlds[0] = world
    plan = worlds[0]
    dt, fastest, square = episode.step_time, 0.0, 0.0
    for step in range(episode.steps):
        episode.step = step
        load(episode, plan)
        velocity = wrist_velocity(episode, plan)
        drive_wrist(episode, plan, velocity[0], velocity[1], velocity[2])
        for a in range(3):  # the object goes with the wrist, whose velocity changes linearly in the step
            plan.wrist_velocity[a] += 0.5 * dt * plan.wrist_acceleration[a]
            plan.wrist[a] += 0.5 * dt * plan.wrist_velocity[a]
        cos, sin = pad_axes(plan)
        x, z = plan.grasp_point[0], plan.grasp_point[1]
        plan.com[0] = plan.wrist[0] - cos * x + sin * z
        plan.com[1] = plan.wrist[1] - sin * x - cos * z
        loads[0, step], loads[1, step], loads[2, step] = load_at_rest(episode, plan)
        loads[3, step] = friction_factor(episode, plan)
        loads[4, step] = plan.inertia + plan.mass * (x * x + z * z)
        across, along = plan.wrist_acceleration[0], plan.wrist_acceleration[1] + plan.gravity
        if across * across + along * along > 0.999 * square:  # the length costs more
            square = max(square, across * across + along * along)
            fastest = max(fastest, math.hypot(across, along))
        for a in range(3):
            plan.wrist[a] += 0.5 * dt * plan.wrist_velocity[a]
            plan.wrist_velocity[a] += 0.5 * dt * plan.wrist_acceleration[a]
    episode.step = 0
    return fastest


@compiled
def swung(episode, loads, grip):
    """Torques on soft pads in a grip, whose torsion the object swings on (steps,) [N m]."""
    torques = np.empty(loads.shape[1])
    angle, rate, stiffness = 0.0, 0.0, torsional_stiffness(episode, grip)
    for k in range(loads.shape[1]):
        torques[k], angle, rate = swing(episode, loads[4, k], loads[2, k], stiffness, angle, rate)
    return torques


@compiled_call
def least_through(episode, loads, torques, every):
    """Least grip that keeps both pads stuck under a sequence of loads.

    Args:
        episode: EPISODE record, with mu_s and r.
        loads: From `plan_loads`.
        torques: On the pads (steps,) [N m].
        every: Whether the mean is needed on soft pads, too.

    Returns:
        Largest and mean least grip [N], where the mean counts each step with at least the gripper's smallest
        force.
    """
    steps, least = loads.shape[1], episode.force_min
    needs, shares, pads = np.empty(steps), np.empty(steps), bearing(episode)
    for k in range(steps):
        needs[k], shares[k] = demand(pads, (loads[0, k], loads[1, k], torques[k]), loads[3, k])
    first, total = 0, 0.0
    for k in range(steps):
        total += max(needs[k], least)
        first = k if needs[k] > needs[first] else first
    peak = needs[first]
    if not varies(episode) or peak == 0.0:
        return peak, total / steps
    # most steps need less than the one found first, at the friction and r of that one
    peak, x, c = on_soft_pads(episode, peak, shares[first], math.log(peak / episode.reference_force))
    most, total = square_at(needs[first], shares[first], c), 0.0
    for k in range(steps):
        grip, higher = 0.0, square_at(needs[k], shares[k], c) > most
        if higher or (every and needs[k] > 0.0):
            grip, x, now = on_soft_pads(episode, needs[k], shares[k], x)
            if higher:
                peak, c, most = grip, now, square_at(needs[k], shares[k], now)
        total += max(grip, least)
    return peak, total / steps


@compiled
def rehearse(episode, world, every):
    """Least grip that keeps both pads stuck through the episode, as far as its start determines it.

    On soft pads the object swings, by how much depends on the grip: the grip is found by repetition, from
    that without swing on. The episode is at step 0 and has mu_s and r; `every` is as for `least_through`.

    Returns:
        As `least_through`, and as `plan_loads`.
    """
    loads = np.empty((_ROWS, episode.steps))
    fastest = plan_loads(episode, world, loads)
    swings = _REPETITIONS if episode.compliance > 0.0 else 0
    peak, mean = least_through(episode, loads, loads[2], every and swings == 0)
    for k in range(swings):
        torques = swung(episode, loads, max(peak, episode.force_min))
        peak, mean = least_through(episode, loads, torques, every and k == swings - 1)
    return peak, mean, fastest


@compiled
def spend(episode, fingers):
    """Add the grip of this control step, once, to the sum over the steps so far."""
    if episode.step > episode.grip_counted:
        episode.grip_counted = episode.step
        episode.grip_sum += mean_force(fingers)


@term(scale=0.5)
def still(episode, world, fingers):
    """exp(-(s / tolerance)^2), s = slip displacement at the pad centre."""
    return math.exp(-((slip_distance(world) / episode.tolerance) ** 2))


STILL_WIDTH = 0.015
"""Width of `still_wide` [m]."""


@term(scale=0.0)
def still_wide(episode, world, fingers):
    """exp(-(s / 15 mm)^2), the same s: it has a slope where `still` is 0."""
    return math.exp(-((slip_distance(world) / STILL_WIDTH) ** 2))


WRIST_COLUMNS = (
    Column("wrist_velocity_x", -2.0, 2.0, "m/s", "commanded wrist velocity along world x",
           "world.wrist_velocity[0]"),
    Column("wrist_velocity_z", -2.0, 2.0, "m/s", "commanded wrist velocity along world z",
           "world.wrist_velocity[1]"),
    Column("wrist_pitch_rate", -10.0, 10.0, "rad/s", "commanded wrist pitch rate",
           "world.wrist_velocity[2]"),
)  # fmt: skip
"""The wrist's velocity, of tasks whose wrist moves."""
