"""Let the object hang upright while the wrist pitches, without sliding.

## Description

A parallel gripper holds a box near its top. The wrist pitches along a trapezoidal profile. The grip must be
loose enough that the box stays upright, turning between the pads like a door on a hinge, and firm enough
that the box does not slide down. The task follows the hinge of Waltersson and Karayiannidis (arXiv
2410.19660).

Sliding and tilt are coupled. While the box turns in the grip, the slip twist is normal to the limit surface
at the load: the box slides r^2 / (d sin(tilt)) per radian, where d is the depth of its centre of mass below
the pads. For a pad with r = 10 mm, d = 100 mm and a tilt of 5 deg that is 11 mm per radian, whatever the
controller does.

The task therefore has its own contact, a rounded fingertip with r = 3 mm (`tasks.hinge.radius`, the reset
option `r`). Then f_n mu_c / f_t has to lie between about 1.9, for 2 mm in a turn of 60 deg, and 3.1, for 5
deg. Static friction, 1.4 to 1.6 times larger, makes the start difficult: a grip in that range would carry
the box along by more than 5 deg before it slips.

## Rewards

e is the difference between the wrist's pitch and its profile; it is 0 unless the agent moves the wrist. It
counts as tilt, for success too, so that an agent cannot simply undo the turn.

## Starting State

The box (`tasks.hinge.object`: 0.2 kg, 50 mm by 250 mm, gripped 100 mm above its centre) hangs at rest in a
grip of `tasks.hinge.initial_force` (5 N), with the wrist level. The direction of the turn is sampled at
random. The wrist rests for `settle` (0.5 s), pitches by `turn` (60 deg) in `duration` (5 s), and rests for
`hold` (1 s).

## Episode End

- Terminated: the box is dropped.
- Truncated: settle + duration + hold have passed (6.5 s, 780 control steps).

Success (`info["is_success"]`): the episode was played to its end, and the box was never dropped, never slid
further than `slide_tolerance` (2 mm) at the pad centre and never tilted by more than `tilt_tolerance` (5
deg). A further slide or tilt is the violation that `violated` reports.

## Info

| `reference` | pitch of the wrist, its rate and acceleration, (3,) [rad, rad/s, rad/s^2] |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config.base import NonNegative, Positive
from slipgym.config.hardware import ObjectConfig
from slipgym.config.task import InitialForce, TaskConfig, TaskObject, TaskRadius, setting
from slipgym.tasks.disturbance import shake_velocity
from slipgym.tasks.episode import schedule, scratch, slip_distance, track_slip, trapezoid
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import Column, Task, term
from slipgym.tasks.terms import OUTCOME, TIME_LEFT, VIOLATED, effort, smoothness

SCRATCH = scratch(scripted_pitch=1)
"""`scripted_pitch`: pitch of the wrist by the script alone, without the agent's commands [rad]."""


class Settings(TaskConfig):
    """Settings of the hinge: the object hangs upright between the pads while the wrist pitches."""

    turn: Annotated[Positive, setting("Angle by which the wrist pitches", "rad", reset=True, le=3.0)] = 1.0472
    direction: Annotated[
        Literal[-1, 1] | None, setting("Sign of the turn, 1 or -1; null: drawn at random", reset=True)
    ] = None
    duration: Annotated[Positive, setting("Time for the turn", "s", reset=True, le=120.0)] = 5.0
    settle: Annotated[NonNegative, setting("Time held before the turn", "s", reset=True, le=60.0)] = 0.5
    hold: Annotated[NonNegative, setting("Time held after the turn", "s", reset=True, le=60.0)] = 1.0
    slide_tolerance: Annotated[Positive, setting("Largest slip for success", "m", reset=True)] = 0.002
    tilt_tolerance: Annotated[Positive, setting("Largest tilt for success", "rad", reset=True)] = 0.0873
    initial_force: InitialForce = 5.0
    object: TaskObject = ObjectConfig(
        mass=0.2, size=(0.05, 0.03, 0.25), com_offset=(0.0, 0.0), inertia=None, grasp_offset=(0.0, 0.1)
    )
    radius: TaskRadius = 0.003  # a rounded fingertip: see docs/environments/hinge.md


def start(settings: Settings, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; the direction of the turn is sampled at random.

    Raises:
        ValueError: The wrist cannot turn so fast.
    """
    schedule(settings, episode)
    turn, fastest = settings.turn, episode["wrist_pitch_rate_max"]
    rate = trapezoid(0.5 * episode["duration"], turn, episode["duration"])[1]
    if rate > fastest:
        raise ValueError(
            f"a turn of {turn:g} rad in duration = {episode['duration']:g} s needs {rate:.3g} rad/s; "
            f"gripper.wrist_pitch_rate_max is {fastest:g} rad/s"
        )
    random = (-1, 1)[rng.integers(2)]  # always sampled, so that options do not shift later draws
    episode["goal"] = turn * (settings.direction or random)
    episode["slide_tolerance"], episode["tilt_tolerance"] = settings.slide_tolerance, settings.tilt_tolerance


def wrist_velocity(episode, world):
    """Pitch the wrist along a trapezoid, and store the scripted pitch."""
    time = (episode.step + 1) * episode.step_time - episode.settle
    last = trapezoid(time - episode.step_time, episode.goal, episode.duration)[1]
    rate = trapezoid(time, episode.goal, episode.duration)[1]
    shaken = shake_velocity(episode, 2, episode.step * episode.step_time)
    shaken += shake_velocity(episode, 2, (episode.step + 1) * episode.step_time)
    episode.own[SCRATCH.scripted_pitch] += 0.5 * (last + rate + shaken) * episode.step_time
    return 0.0, 0.0, rate


def track(episode, world, fingers):
    """Set the reference to the wrist's pitch, and store the largest slip and tilt."""
    episode.reference[0] = world.wrist[2]
    episode.reference[1] = world.wrist_velocity[2]
    episode.reference[2] = world.wrist_acceleration[2]
    track_slip(episode, world)
    episode.largest_tilt = max(episode.largest_tilt, tilt(episode, world))


@compiled
def tilt(episode, world):
    """Turn of the object since reset or, if larger, how far the wrist strayed from its script [rad].

    An agent that moves the wrist cannot just undo the turn.
    """
    return max(abs(world.angle), abs(world.wrist_plan[2] - episode.own[SCRATCH.scripted_pitch]))


def violated(episode, world, fingers):
    """Whether the object slid or tilted far."""
    return episode.largest_slip > episode.slide_tolerance or episode.largest_tilt > episode.tilt_tolerance


@term(scale=0.5)
def still(episode, world, fingers):
    """exp(-(s / slide_tolerance)^2), s = slip at the pad centre."""
    return math.exp(-((slip_distance(world) / episode.slide_tolerance) ** 2))


@term(scale=0.5)
def upright(episode, world, fingers):
    """exp(-(tilt / tilt_tolerance)^2), tilt = turn of the box since reset or, if larger, e."""
    return math.exp(-((tilt(episode, world) / episode.tilt_tolerance) ** 2))


TASK = Task(
    id="slipgym/Hinge-v0",
    settings=Settings,
    start=start,
    wrist_velocity=wrist_velocity,
    track=track,
    violated=violated,
    terms=(still, upright, effort, smoothness, *OUTCOME),
    columns=(
        Column("wrist_pitch", -10.0, 10.0, "rad", "pitch of the wrist since the start",
               "episode.reference[0]"),
        Column("wrist_pitch_rate", -10.0, 10.0, "rad/s", "its rate", "episode.reference[1]"),
        Column("wrist_pitch_acceleration", -100.0, 100.0, "rad/s^2", "its second rate",
               "episode.reference[2]"),
        Column("wrist_pitch_goal", -10.0, 10.0, "rad", "pitch at the end of the turn", "episode.goal"),
        TIME_LEFT,
        VIOLATED,
    ),
    motion=Motion("turned in the grip", "rad", (0.0, 0.0, 1.0), sign=-1.0, goal="wrist_pitch_goal",
                  body="tool", end=lambda episode: (0.0, 0.0, -float(episode["reference"][0]))),
    page=__doc__,
)  # fmt: skip
