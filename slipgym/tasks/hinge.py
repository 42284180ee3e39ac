"""Let the object hang upright while the wrist pitches, without sliding.

## Description

A parallel gripper holds a box near its top. The wrist pitches along a trapezoidal profile, and the grip
must be so loose that the box stays upright, turning between the pads like a door on a hinge, and so
firm that it does not slide down. Friction is not known beforehand: an estimator works it out from
force, torque and slip velocity while the box turns. After the hinge of Waltersson and Karayiannidis
(arXiv 2410.19660), who pitch from 60 to 120 deg; only the relative turn matters to round pads.

Sliding and tilt are bound to each other. While the box turns in the grip, the slip twist is normal to
the limit surface at the load: it slides r^2 / (d sin(tilt)) per radian, d being the depth of its centre
of mass below the pads. For a pad with r = 10 mm, d = 100 mm and a tilt of 5 deg that is 11 mm per
radian, whatever the controller does. Hence the task's own contact: a rounded fingertip that touches
with r = 3 mm (`tasks.hinge.radius`, the reset option `r`). Then f_n mu_c / f_t has to lie between about
1.9, for 2 mm in a turn of 60 deg, and 3.1, for 5 deg. Static friction, 1.4 to 1.6 times larger, makes
the start the hard part: a grip in that range would take the box along by more than 5 deg before it lets
go.

## Rewards

e is how far the wrist's pitch is from its profile: 0, unless the agent moves the wrist. It counts as
tilt, for success too, so that an agent cannot just undo the turn.

## Starting State

The box (`tasks.hinge.object`: 0.2 kg, 50 mm by 250 mm, gripped 100 mm above its centre) hangs still in
a grip of `tasks.hinge.initial_force` (5 N), the wrist level. The direction of the turn is drawn; so are
the material, if `material` is "random", the sensors' biases and the fractions of a count that the slip
sensors begin with. Grip and sensors run for six samples before time 0. The wrist rests for `settle`
(0.5 s), pitches by `turn` (60 deg) in `duration` (5 s), and rests for `hold` (1 s).

## Episode End

- Terminated: the box is dropped, that is, neither pad touches it or a pad reaches beyond its edge.
- Truncated: settle + duration + hold have passed (6.5 s, 780 samples). The environment truncates by
  itself; no `TimeLimit` is needed.

Success (`info["is_success"]`): the episode was played to its end, and the box was never dropped, never
slid further than `slide_tolerance` (2 mm) at the pad centre and never tilted by more than
`tilt_tolerance` (5 deg).

## Info

| `reference` | pitch of the wrist, its rate and acceleration, (3,) [rad, rad/s, rad/s^2] |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from pydantic import Field

from slipgym._numba.compiled import compiled
from slipgym.config import Config, TaskConfig
from slipgym.config.base import NonNegative, Positive
from slipgym.tasks.disturbance import shake_velocity
from slipgym.tasks.episode import detect_drop, drive_wrist, effort, note_slip, roughness, schedule, trapezoid
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import DROP, EFFORT, SMOOTHNESS, Column, Task, Term

_SCRIPTED_PITCH = 0  # place in the episode's own numbers: of the wrist, as the script alone turns it [rad]


class Settings(TaskConfig):
    """The object hangs upright between the pads while the wrist pitches."""

    turn: Positive = Field(description="Angle by which the wrist pitches [rad]")
    duration: Positive = Field(description="Time for it [s]")
    settle: NonNegative = Field(description="Time before the wrist moves [s]")
    hold: NonNegative = Field(description="Time after it has moved [s]")
    slide_tolerance: Positive = Field(description="Largest slip at the pad centre for success [m]")
    tilt_tolerance: Positive = Field(description="Largest tilt of the object for success [rad]")


DEFAULTS = {
    "turn": 1.0472,  # 60 degrees
    "duration": 5.0,
    "settle": 0.5,
    "hold": 1.0,
    "slide_tolerance": 0.002,
    "tilt_tolerance": 0.0873,  # 5 degrees
    "initial_force": 5.0,
    "object": {
        "mass": 0.2,
        "size": [0.05, 0.03, 0.25],
        "com_offset": [0.0, 0.0],
        "inertia": None,
        "grasp_offset": [0.0, 0.1],
    },
    "radius": 0.003,  # a rounded fingertip: see docs/environments/hinge.md
}
REWARD = (
    Term("still", 1.0, "exp(-(s / slide_tolerance)^2), s = slip at the pad centre"),
    Term(
        "upright", 1.0, "exp(-(tilt / tilt_tolerance)^2), tilt = turn of the box since reset or, if larger, e"
    ),
    Term("effort", 0.1, EFFORT),
    Term("smoothness", 0.1, SMOOTHNESS),
    Term("drop", 100.0, DROP),
)
COLUMNS = (
    Column("wrist_pitch", -10.0, 10.0, "rad", "pitch of the wrist since the start"),
    Column("wrist_pitch_rate", -10.0, 10.0, "rad/s", "its rate"),
    Column("wrist_pitch_acceleration", -100.0, 100.0, "rad/s^2", "its second rate"),
    Column("wrist_pitch_goal", -10.0, 10.0, "rad", "pitch at the end of the turn"),
    Column("time_left", 0.0, 1000.0, "s", "time until the episode ends"),
)


class Options(EpisodeOptions):
    """What `reset(options=...)` can fix."""

    turn: Positive | None = Field(default=None, le=3.0, description="Angle by which the wrist pitches [rad]")
    direction: Literal[-1, 1] | None = Field(default=None, description="Its sign, 1 or -1 [-]")
    duration: Positive | None = Field(default=None, le=120.0, description="Time for the turn [s]")
    settle: NonNegative | None = Field(default=None, le=60.0, description="Time held before the turn [s]")
    hold: NonNegative | None = Field(default=None, le=60.0, description="Time held after the turn [s]")
    slide_tolerance: Positive | None = Field(default=None, description="Largest slip for success [m]")
    tilt_tolerance: Positive | None = Field(default=None, description="Largest tilt for success [rad]")


def start(config: Config, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; the direction of the turn is drawn.

    Raises:
        ValueError: The wrist cannot turn so fast.
    """
    task = config.tasks.hinge
    schedule(options, task, episode)
    turn, fastest = options.choose("turn", task), config.gripper.wrist_pitch_rate_max
    rate = trapezoid(0.5 * episode["duration"], turn, episode["duration"])[1]
    if rate > fastest:
        raise ValueError(
            f"a turn of {turn:g} rad in duration = {episode['duration']:g} s needs {rate:.3g} rad/s; "
            f"gripper.wrist_pitch_rate_max is {fastest:g} rad/s"
        )
    drawn = (-1, 1)[rng.integers(2)]  # drawn always, so that options do not shift later draws
    episode["goal"] = turn * (getattr(options, "direction", None) or drawn)
    for field in ("slide_tolerance", "tilt_tolerance"):
        episode[field] = options.choose(field, task)


@compiled
def plan(episodes, worlds):
    """Before a control step: the wrist's motion over the coming step."""
    for i in range(episodes.shape[0]):
        episode, world = episodes[i], worlds[i]
        time = (episode.step + 1) * episode.step_time - episode.settle
        last = trapezoid(time - episode.step_time, episode.goal, episode.duration)[1]
        rate = trapezoid(time, episode.goal, episode.duration)[1]
        shaken = shake_velocity(episode, 2, episode.step * episode.step_time)
        shaken += shake_velocity(episode, 2, (episode.step + 1) * episode.step_time)
        episode.own[_SCRIPTED_PITCH] += 0.5 * (last + rate + shaken) * episode.step_time
        drive_wrist(episode, world, 0.0, 0.0, rate)


@compiled
def judge(episodes, worlds, fingers, columns):
    """After a control step: wrist motion, reward terms, outcome, observation.

    Args:
        episodes: EPISODE (n,).
        worlds: WORLD (n,).
        fingers: FINGER (n, 2).
        columns: Output (n, 5), see `COLUMNS`.
    """
    for i in range(episodes.shape[0]):
        episode, world = episodes[i], worlds[i]
        episode.reference[0] = world.wrist[2]
        episode.reference[1] = world.wrist_velocity[2]
        episode.reference[2] = world.wrist_acceleration[2]
        slip = note_slip(episode, world)
        # an agent that moves the wrist cannot just undo the turn: straying from it counts as tilt
        tilt = max(abs(world.angle), abs(world.wrist_plan[2] - episode.own[_SCRIPTED_PITCH]))
        episode.largest_tilt = max(episode.largest_tilt, tilt)
        episode.dropped = detect_drop(episode, world, fingers[i])
        episode.success = (
            episode.step >= episode.steps
            and not episode.dropped
            and episode.largest_slip <= episode.slide_tolerance
            and episode.largest_tilt <= episode.tilt_tolerance
        )
        terms = (
            math.exp(-((slip / episode.slide_tolerance) ** 2)),
            math.exp(-((tilt / episode.tilt_tolerance) ** 2)),
            -effort(episode, fingers[i]),
            -roughness(episode),
            -1.0 if episode.dropped else 0.0,
        )
        for k in range(5):
            episode.terms[k] = episode.scales[k] * terms[k]
        for k in range(3):
            columns[i, k] = episode.reference[k]
        columns[i, 3] = episode.goal
        columns[i, 4] = (episode.steps - episode.step) * episode.step_time


TASK = Task(
    id="slipgym/Hinge-v0",
    key="hinge",
    settings=Settings,
    defaults=DEFAULTS,
    options=Options,
    reward=REWARD,
    columns=COLUMNS,
    start=start,
    plan=plan,
    judge=judge,
    motion=Motion("turned in the grip", "rad", (0.0, 0.0, 1.0), sign=-1.0, goal="wrist_pitch_goal"),
    page=__doc__,
)
