"""Swing the object to a given angle in the grip within a second, without sliding.

## Description

A parallel gripper holds a light box near its top. The agent commands the grip force and the velocity of the
wrist. Within `duration` (1 s) the box has to turn about the grip axis by `goal`, 20 to 80 deg either way,
and then stay. Gravity alone lets the box hang; so the wrist has to accelerate while the grip is loose, the
box swings up like a pendulum, and the grip has to close when it arrives.

This is pivoting, as Holladay, Paolini and Mason planned it (ICRA 2015), with the wrist as the drive. The
wrist reaches 1.7 m/s and 15 m/s^2 (`tasks.pivot_to.wrist_speed`, `wrist_acceleration`), about the limits of
a Franka Emika arm. The acceleration counts what the agent commands, along x and z together. mu_c is drawn
from 0.3 to 0.9, log-uniformly (`tasks.pivot_to.friction_range`).

Friction has to be neither small nor large. Some sliding is inevitable, since the slip twist is normal to the
limit surface at the load: with k = 2 mu_c f_n / f_t the box slides r / sqrt(k^2 - 1) per radian. With r =
3 mm and k = 10 that is 0.42 mm for 80 deg, and more in the swing.

On the other side, the torque of the pads, k r f_t, has to be well below that of the wrist, m d a, and at the
end friction has to hold the box beside the pads. The task therefore has its own contact, a rounded fingertip
with r = 3 mm (`tasks.pivot_to.radius`, the reset option `r`), and the box is light, an empty carton of 30 g.

## Action Space

`Box(-1, 1, (3,), float32)`, the `action_mode` "grip_force_translation": the grip force commanded to both
fingers, where -1 is `gripper.force_min` (0.6 N) and +1 is `gripper.force_max` (25 N), and the velocity of
the wrist along world x and z, up to `tasks.pivot_to.wrist_speed` (1.7 m/s) either way. The actuator
force follows with a dead time (4 ms) and a first-order lag (12 ms), the wrist with at most
`tasks.pivot_to.wrist_acceleration`.

Other values of `action_mode` change the components (see docs/modes.md); without the wrist's velocity the
goal is out of reach.

## Rewards

e is the error of the angle in the grip or, if larger, of the box's angle in the world: an agent that pitches
the wrist ("grip_force_wrist") has to pitch it back.

## Starting State

The box (`tasks.pivot_to.object`: 30 g, 50 mm by 250 mm, gripped 100 mm above its centre) hangs at rest in a
grip of `tasks.pivot_to.initial_force` (5 N), with the wrist level and at rest. Sampled at random are the
angle, its sign and friction.

## Episode End

- Terminated: the box is dropped.
- Truncated: `duration` + `hold` have passed (1.2 s, 144 control steps).

Success (`info["is_success"]`): the episode was played to its end, and the box was never dropped, never slid
further than `slide_tolerance` (1 mm) at the pad centre, and was within `tolerance` (5 deg) of its angle from
`duration` to the end; at the end it rests (no point of the pads slips faster than `rest_speed`, 1 mm/s), and
so does the wrist (`wrist_rest`, 0.1 m/s). A further slide, and a larger error after `duration`, are the
violations that `violated` reports.

## Info

| `reference` | angle to turn, (3,) [rad]; the last two are 0 |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config.base import NonNegative, Positive, PositiveInterval, ends_within
from slipgym.config.hardware import ObjectConfig
from slipgym.config.task import (
    FrictionRange,
    InitialForce,
    Option,
    TaskConfig,
    TaskObject,
    TaskRadius,
    WristSpeed,
    setting,
)
from slipgym.tasks.disturbance import shake_velocity
from slipgym.tasks.episode import between, scratch, track_slip
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import Column, Task, term
from slipgym.tasks.terms import OUTCOME, TIME_LEFT, VIOLATED, effort, sliding, smoothness

SCRATCH = scratch(acceleration=1, rest_speed=1, wrist_rest=1)
"""`acceleration`: largest of the wrist [m/s^2]; `rest_speed`, `wrist_rest`: largest final speed of the slip
at the pads' rim and of the wrist [m/s]."""
WIDTH = 0.5
"""Width of `angle_wide` [rad]."""
_ANGLE = Option(float, "Angle to turn in the grip, either way [rad]", {"ge": -1.6, "le": 1.6})


class Settings(TaskConfig):
    """Settings of the pivot: the object swings to a given angle in the grip, then stops."""

    angle: Annotated[
        PositiveInterval,
        ends_within(1e-3, 1.6),
        setting("The angle to turn, either way, is sampled from this range", "rad", reset=_ANGLE),
    ] = (0.3491, 1.3963)  # 20 to 80 degrees
    duration: Annotated[Positive, setting("Time for the turn", "s", reset=True, le=60.0)] = 1.0
    hold: Annotated[NonNegative, setting("Time held after the turn", "s", reset=True, le=60.0)] = 0.2
    tolerance: Annotated[Positive, setting("Largest error of the angle for success", "rad", reset=True)] = (
        0.0873  # 5 degrees
    )
    slide_tolerance: Annotated[Positive, setting("Largest slip for success", "m", reset=True)] = 0.001
    rest_speed: Annotated[
        Positive, setting("Largest final slip speed at the pad's rim for success", "m/s")
    ] = 0.001
    wrist_rest: Annotated[Positive, setting("Largest final speed of the wrist for success", "m/s")] = 0.1
    wrist_acceleration: Annotated[
        Positive, setting("Largest acceleration of the wrist in the contact plane", "m/s^2", le=1000.0)
    ] = 15.0
    initial_force: InitialForce = 5.0
    friction_range: FrictionRange = (0.3, 0.9)
    wrist_speed: WristSpeed = 1.7
    object: TaskObject = ObjectConfig(  # light, its centre of mass 100 mm below the pads
        mass=0.03, size=(0.05, 0.03, 0.25), com_offset=(0.0, 0.0), inertia=None, grasp_offset=(0.0, 0.1)
    )
    radius: TaskRadius = 0.003  # a rounded fingertip: see docs/environments/pivot_to.md


def start(settings: Settings, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; the angle and its sign are sampled at random."""
    shares = rng.random(2).tolist()  # always sampled, so that options do not shift later draws
    drawn = between(settings.angle, shares[0]) * (1.0 if shares[1] < 0.5 else -1.0)
    fixed = options.model_dump()["angle"]
    episode["goal"] = drawn if fixed is None else fixed
    episode["tolerance"], episode["slide_tolerance"] = settings.tolerance, settings.slide_tolerance
    episode["duration"] = settings.duration
    own = episode["own"]
    own[SCRATCH.acceleration] = settings.wrist_acceleration
    own[SCRATCH.rest_speed], own[SCRATCH.wrist_rest] = settings.rest_speed, settings.wrist_rest
    total = settings.duration + settings.hold
    episode["steps"] = max(1, round(total / episode["step_time"].item()))


def wrist_velocity(episode, world):
    """Limit the acceleration of the wrist: what the limit takes from the agent's command."""
    time = episode.step * episode.step_time
    x = world.wrist_velocity[0] - shake_velocity(episode, 0, time)
    z = world.wrist_velocity[1] - shake_velocity(episode, 1, time)
    given_x, given_z = episode.wrist_command[0], episode.wrist_command[1]
    fraction = min(1.0, episode.wrist_speed_max / max(math.hypot(given_x, given_z), 1e-12))
    dx, dz = fraction * given_x - x, fraction * given_z - z
    most = episode.own[SCRATCH.acceleration] * episode.step_time
    fraction = min(1.0, most / max(math.hypot(dx, dz), 1e-12))
    return x + fraction * dx - given_x, z + fraction * dz - given_z, 0.0


def track(episode, world, fingers):
    """Set the reference to the goal, and store the largest slip."""
    episode.reference[0] = episode.goal
    track_slip(episode, world)


@compiled
def angle_error(episode, world):
    """Error of the angle in the grip or, if larger, of that in the world [rad].

    An agent that pitches the wrist has to pitch it back.
    """
    return max(abs(world.slip[2] - episode.goal), abs(world.angle - episode.goal))


def violated(episode, world, fingers):
    """Whether the object slid far, or is not at its angle though the time for the turn is over."""
    late = episode.step * episode.step_time >= episode.duration - 1e-9
    return episode.largest_slip > episode.slide_tolerance or (
        late and angle_error(episode, world) > episode.tolerance
    )


def success(episode, world):
    """Whether object and wrist rest."""
    twist, velocity = world.slip_twist, world.wrist_velocity
    rim = math.hypot(math.hypot(twist[0], twist[1]), episode.pad_radius * twist[2])
    time = episode.step * episode.step_time
    x, z = (velocity[0] - shake_velocity(episode, 0, time), velocity[1] - shake_velocity(episode, 1, time))
    return rim <= episode.own[SCRATCH.rest_speed] and math.hypot(x, z) <= episode.own[SCRATCH.wrist_rest]


@term(scale=0.5)
def angle(episode, world, fingers):
    """exp(-(e / tolerance)^2), e = error of the angle."""
    return math.exp(-((angle_error(episode, world) / episode.tolerance) ** 2))


@term(scale=0.0)
def angle_wide(episode, world, fingers):
    """exp(-(e / 0.5 rad)^2), the same e: it has a slope where `angle` is 0."""
    return math.exp(-((angle_error(episode, world) / WIDTH) ** 2))


@term(scale=0.5)
def distance(episode, world, fingers):
    """-e / pi."""
    return -angle_error(episode, world) / math.pi


TASK = Task(
    id="slipgym/PivotTo-v0",
    settings=Settings,
    start=start,
    wrist_velocity=wrist_velocity,
    track=track,
    success=success,
    violated=violated,
    terms=(angle, distance, sliding, effort, smoothness, *OUTCOME, angle_wide),
    columns=(
        Column("goal", -2.0, 2.0, "rad", "angle to turn in the grip", "episode.goal"),
        TIME_LEFT,
        VIOLATED,
    ),
    action_mode="grip_force_translation",
    motion=Motion("turned in the grip", "rad", (0.0, 0.0, 1.0), goal="goal",
                  end=lambda episode: (0.0, 0.0, float(episode["goal"]))),
    page=__doc__,
)  # fmt: skip
