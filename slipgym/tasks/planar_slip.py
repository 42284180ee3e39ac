"""Bring the object to a pose (x, y, theta) in the grip, by gravity, wrist and grip force.

## Description

A parallel gripper holds a box at its centre of mass. The agent slides and turns the box between the pads
until its slip displacement is a given (x, y, theta). Gravity alone moves the box: the wrist's pitch sets the
direction of gravity in the pad frame, and the grip force sets the friction that opposes it.

The limit surface determines which poses can be reached. Let b be the position of the pad centre on the box,
from its centre of mass, and u the upward direction, both in the box's frame. In slow slip the pads move on
the box along u. The load is the weight, with the torque of its lever b x u, and the slip twist is normal to
the ellipsoid at the load. The box therefore turns against the pads, per length of the slide, by (b x u) /
r^2:

    d theta = (b x db) / r^2

If b is 0 or along u, with the centre of mass straight below or above the pads, the box slides without
turning, for any pitch of the wrist. With the centre of mass to the side at a distance s it turns, and slides
only r^2 / s per radian. Sequences of slides and turns reach every (x, y, theta). The target is sampled as the
end of such a sequence: a slide by `slide` with the wrist pitched by `heading`, then a turn by `turn` about
the pad centre.

The task has its own contact, a rounded fingertip with r = 5 mm (`tasks.planar_slip.radius`, the reset option
`r`), which slides by 1.7 mm per radian where a pad with r = 10 mm would slide by 6.7 mm.

The measured slip is the time integral of the slip velocity at the pad centre, in the pad frame. The target
refers to another quantity, the displacement of the point of the box that lay at the pad centre at the grasp.
A turn moves that point as well: d(x, y) = d(measured slip) + d theta (-y, x).

## Action Space

`Box(-1, 1, (2,), float32)`: the grip force commanded to both fingers; -1 is `gripper.force_min` (0.6 N) and
+1 is `gripper.force_max` (25 N). Then the wrist's pitch rate, from -3 to 3 rad/s
(`gripper.wrist_pitch_rate_max`). The actuator force follows with a dead time (4 ms) and a first-order lag (12
ms), the pitch rate within a control step.

This is "grip_force_pitch", the `action_mode` of this task. Other modes add components, leave some out or
change their meaning (see docs/modes.md).

## Starting State

The box (`tasks.planar_slip.object`: 0.2 kg, 160 mm by 200 mm, gripped at its centre of mass) is held in a
grip of `tasks.planar_slip.initial_force` (10 N), with the wrist level. Sampled at random are the target
(`slide` 10 to 18 mm, `heading` up to 60 deg and `turn` 10 to 40 deg, both in either direction).

## Episode End

- Terminated: the box is dropped.
- Truncated: `duration` has passed (12 s, 1440 control steps).

Success (`info["is_success"]`): the episode was played to its end, the box was not dropped, and at the end
its slip displacement is within `tolerance` (2 mm) of the target in (x, y) and within `angle_tolerance` (3
deg) in theta, at rest: no point of the pads slips faster than `rest_speed` (1 mm/s). Nothing before the end
makes it impossible: `violated` is always 0.

## Info

| `reference` | the target (x, y, theta), (3,) [m, m, rad] |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config.base import NonNegative, Positive, PositiveInterval
from slipgym.config.hardware import ObjectConfig
from slipgym.config.task import InitialForce, Option, TaskConfig, TaskObject, TaskRadius, setting
from slipgym.tasks.episode import scratch
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import Column, Task, term
from slipgym.tasks.terms import TIME_LEFT, VIOLATED, drop, effort, smoothness, solved

SCRATCH = scratch(target=3, angle_tolerance=1, rest_speed=1)
"""`target`: slip displacement to reach [m, m, rad]; `angle_tolerance` [rad]; `rest_speed` [m/s]."""
_SLIDE = Option(Positive, "Length of the target's slide [m]", {"le": 0.1})
_HEADING = Option(float, "Pitch of the wrist during that slide [rad]", {"ge": -1.6, "le": 1.6})
_TURN = Option(float, "Angle of the target's turn [rad]", {"ge": -1.6, "le": 1.6})


class Settings(TaskConfig):
    """Settings of the planar slip: the object is moved in the grip to a given pose (x, y, theta)."""

    slide: Annotated[
        PositiveInterval, setting("The target's slide is sampled from this range", "m", reset=_SLIDE)
    ] = (0.010, 0.018)
    heading: Annotated[
        NonNegative, setting("Largest pitch of the wrist during the target's slide", "rad", reset=_HEADING)
    ] = 1.0472  # 60 degrees
    turn: Annotated[
        PositiveInterval,
        setting("The target's turn, either way, is sampled from this range", "rad", reset=_TURN),
    ] = (0.1745, 0.6981)  # 10 to 40 degrees
    duration: Annotated[Positive, setting("Length of an episode", "s", reset=True, le=120.0)] = 12.0
    tolerance: Annotated[Positive, setting("Largest final error in (x, y) for success", "m", reset=True)] = (
        0.002
    )
    angle_tolerance: Annotated[
        Positive, setting("Largest final error in theta for success", "rad", reset=True)
    ] = 0.0524  # 3 degrees
    rest_speed: Annotated[
        Positive, setting("Largest final slip speed at the pad's rim for success", "m/s")
    ] = 0.001
    initial_force: InitialForce = 10.0
    object: TaskObject = ObjectConfig(  # large and flat, gripped at its centre of mass
        mass=0.2, size=(0.16, 0.03, 0.2), com_offset=(0.0, 0.0), inertia=None, grasp_offset=(0.0, 0.0)
    )
    radius: TaskRadius = 0.005  # a rounded fingertip: see docs/environments/planar_slip.md


def start(settings: Settings, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; the target is the end of a random slide and a random turn."""
    # always sampled, so that options do not shift later draws
    drawn = {
        "slide": rng.uniform(*settings.slide),
        "heading": rng.uniform(-settings.heading, settings.heading),
        "turn": rng.uniform(*settings.turn) * (-1, 1)[rng.integers(2)],
    }
    fixed = {name: getattr(options, name) for name in drawn}
    slide, heading, turn = (drawn[name] if fixed[name] is None else fixed[name] for name in drawn)
    own = episode["own"]
    own[SCRATCH.target] = hang(slide, heading, turn)
    own[SCRATCH.angle_tolerance], own[SCRATCH.rest_speed] = settings.angle_tolerance, settings.rest_speed
    episode["tolerance"] = settings.tolerance
    episode["steps"] = max(1, round(settings.duration / episode["step_time"]))


def hang(slide: float, heading: float, turn: float) -> tuple[float, float, float]:
    """Slip displacement after a slide along gravity and a turn about the pad centre.

    Args:
        slide: Length of the slide [m].
        heading: Pitch of the wrist during it [rad].
        turn: Angle by which the object then turns in the grip [rad].

    Returns:
        (x, y, theta) [m, m, rad]; (x, y) is the slide, rotated by `turn` about the pad centre.
    """
    down = heading - turn
    return -slide * math.sin(down), -slide * math.cos(down), turn


def track(episode, world, fingers):
    """Set the reference to the target."""
    target = episode.own[SCRATCH.target]
    for k in range(3):
        episode.reference[k] = target[k]


@compiled
def position_error(episode, world):
    """Distance from the target in (x, y) over the tolerance [-]."""
    target = episode.reference
    return math.hypot(world.slip[0] - target[0], world.slip[1] - target[1]) / episode.tolerance


@compiled
def angle_error(episode, world):
    """Distance from the target in theta over the tolerance [-]."""
    return abs(world.slip[2] - episode.reference[2]) / episode.own[SCRATCH.angle_tolerance]


def success(episode, world):
    """Whether the object rests at the target."""
    twist = world.slip_twist
    speed = math.hypot(math.hypot(twist[0], twist[1]), episode.pad_radius * twist[2])
    return (
        position_error(episode, world) <= 1.0
        and angle_error(episode, world) <= 1.0
        and speed <= episode.own[SCRATCH.rest_speed]
    )


@term(scale=0.5)
def position(episode, world, fingers):
    """exp(-e^2), e = error in (x, y) / tolerance."""
    return math.exp(-(position_error(episode, world) ** 2))


@term(scale=0.5)
def angle(episode, world, fingers):
    """exp(-a^2), a = error in theta / angle_tolerance."""
    return math.exp(-(angle_error(episode, world) ** 2))


@term(scale=0.5)
def distance(episode, world, fingers):
    """-(e + a) / 20."""
    return -(position_error(episode, world) + angle_error(episode, world)) / 20.0


@term(scale=0.1)
def wrist(episode, world, fingers):
    """-(commanded speed / its limit)^2 - (commanded pitch rate / its limit)^2."""
    command = episode.wrist_command
    speed = math.hypot(command[0], command[1]) / episode.wrist_speed_max
    rate = command[2] / episode.wrist_pitch_rate_max
    return -(speed**2 + rate**2)


TASK = Task(
    id="slipgym/PlanarSlip-v0",
    settings=Settings,
    start=start,
    track=track,
    success=success,
    terms=(position, angle, distance, effort, smoothness, wrist, solved, drop),
    columns=(
        Column("target_x", -1.0, 1.0, "m", "slip displacement to reach, along the pads' x axis",
               "episode.reference[0]"),
        Column("target_y", -1.0, 1.0, "m", "the same along the pads' y axis", "episode.reference[1]"),
        Column("target_theta", -10.0, 10.0, "rad", "the same about the grip axis", "episode.reference[2]"),
        TIME_LEFT,
        VIOLATED,
    ),
    action_mode="grip_force_pitch",
    motion=Motion("turned in the grip", "rad", (0.0, 0.0, 1.0), entry=2, goal="target_theta",
                  end=lambda episode: tuple(episode["own"][SCRATCH.target].tolist())),
    page=__doc__,
)  # fmt: skip
