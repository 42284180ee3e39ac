"""Let gravity turn the object about the grip axis by a given angle in a given time, without sliding.

## Description

A parallel gripper on a wrist at rest holds a bar near one end. It must loosen its grip just so far that
the bar's weight turns it between the pads along a trapezoidal reference, and then tighten it so that
the bar stays. Friction is not known beforehand: an estimator works it out from force, torque and slip
velocity while the bar turns. After the rotational slip of Waltersson and Karayiannidis (arXiv
2410.19660).

Some sliding is inherent. On the limit surface the slip twist is normal to the load, v_t / omega = r^2
f_t / tau, and tau / f_t is the weight's lever d cos(tilt). A turn from -angle/2 to +angle/2 about
horizontal therefore slides 2 (r^2 / d) ln tan(45 deg + angle/4): with r = 10 mm and d = 180 mm 0.61 mm
at 60 deg, whatever the controller does; on a disc (`contact="distributed"`), whose limit surface is
flatter there, 3/2 as much. Holding the bar level takes m g d / (2 mu_c r) per finger. Hence the task's
own object (`tasks.rotational_slip.object`), light and long: 0.06 kg, 460 mm by 40 mm, gripped 180 mm
from its centre, which asks for 15 N at mu_c 0.36.

In turns of short leaps and almost without translation the estimator "rls" learns little;
the default, like "joint", learns enough.

## Starting State

The bar is held still in a grip of `tasks.rotational_slip.initial_force` (25 N), its grasp point between
the pads and the bar aligned with them. The wrist is pitched by angle/2, the bar's heavy end up, so that
the turn is symmetric about horizontal; the bar turns clockwise, so theta falls. The material is drawn
if `material` is "random"; so are the sensors' biases and the fractions of a count that the slip sensors
begin with. Grip and sensors run for six samples before time 0. The reference rests for `settle` (0.5
s), turns by `angle` (60 deg) in `duration` (5 s), and rests for `hold` (1 s).

## Episode End

- Terminated: the bar is dropped, that is, neither pad touches it or a pad reaches beyond its edge.
- Truncated: settle + duration + hold have passed (6.5 s, 780 samples). The environment truncates by
  itself; no `TimeLimit` is needed.

Success (`info["is_success"]`): the episode was played to its end, the bar is not dropped, -theta is
`angle` within `tolerance` (2 deg), and it never slid further than `slide_tolerance` (1 mm) at the pad
centre.

## Info

| `reference` | angle, angular velocity and acceleration of the reference, (3,) [rad, rad/s, rad/s^2] |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math

import numpy as np
from pydantic import Field

from slipgym._numba.compiled import compiled
from slipgym.config import Config, TaskConfig
from slipgym.config.base import NonNegative, Positive
from slipgym.tasks.episode import detect_drop, drive_wrist, effort, note_slip, roughness, schedule, trapezoid
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import DROP, EFFORT, SMOOTHNESS, Column, Task, Term


class Settings(TaskConfig):
    """The object turns between the pads by a given angle in a given time, then stays."""

    angle: Positive = Field(description="Angle to turn [rad]")
    duration: Positive = Field(description="Time for the turn [s]")
    settle: NonNegative = Field(description="Time before the turn, during which the object is held [s]")
    hold: NonNegative = Field(description="Time after the turn, during which the object is held [s]")
    tolerance: Positive = Field(description="Largest error of the final angle for success [rad]")
    slide_tolerance: Positive = Field(description="Largest slip at the pad centre for success [m]")


DEFAULTS = {
    "angle": 1.0472,  # 60 degrees, symmetric about horizontal
    "duration": 5.0,
    "settle": 0.5,
    "hold": 1.0,
    "tolerance": 0.0349,  # 2 degrees
    "slide_tolerance": 0.001,
    "initial_force": 25.0,
    "object": {  # light and long: see docs/environments/rotational_slip.md
        "mass": 0.06,
        "size": [0.46, 0.03, 0.04],
        "com_offset": [0.0, 0.0],
        "inertia": None,
        "grasp_offset": [-0.18, 0.0],
    },
}
REWARD = (
    Term("tracking", 1.0, "exp(-(e / tolerance)^2), e = -theta - reference"),
    Term("sliding", 0.1, "-min(slip at the pad centre / slide_tolerance, 10)"),
    Term("effort", 0.1, EFFORT),
    Term("smoothness", 0.1, SMOOTHNESS),
    Term("drop", 100.0, DROP),
)
COLUMNS = (
    Column("reference_position", 0.0, 2.0, "rad", "angle the object should have turned, clockwise"),
    Column("reference_velocity", 0.0, 10.0, "rad/s", "its rate"),
    Column("reference_acceleration", -100.0, 100.0, "rad/s^2", "its second rate"),
    Column("angle", 0.0, 2.0, "rad", "angle to turn in the episode"),
    Column("time_left", 0.0, 1000.0, "s", "time until the episode ends"),
)


class Options(EpisodeOptions):
    """What `reset(options=...)` can fix."""

    angle: Positive | None = Field(default=None, le=1.6, description="Angle to turn [rad]")
    duration: Positive | None = Field(default=None, le=120.0, description="Time for the turn [s]")
    settle: NonNegative | None = Field(default=None, le=60.0, description="Time held before the turn [s]")
    hold: NonNegative | None = Field(default=None, le=60.0, description="Time held after the turn [s]")
    tolerance: Positive | None = Field(default=None, description="Largest final error for success [rad]")
    slide_tolerance: Positive | None = Field(default=None, description="Largest slip for success [m]")


def start(config: Config, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; nothing here is drawn at random.

    The wrist starts pitched by half the angle, so that the turn is symmetric about horizontal.
    """
    task = config.tasks.rotational_slip
    episode["goal"] = options.choose("angle", task)
    for field in ("tolerance", "slide_tolerance"):
        episode[field] = options.choose(field, task)
    schedule(options, task, episode)
    episode["wrist_start"] = 0.0, 0.0, 0.5 * episode["goal"]


@compiled
def plan(episodes, worlds):
    """Before a control step: the wrist stays where it is, but for what the agent commands."""
    for i in range(episodes.shape[0]):
        drive_wrist(episodes[i], worlds[i], 0.0, 0.0, 0.0)


@compiled
def judge(episodes, worlds, fingers, columns):
    """After a control step: reference, reward terms, outcome, observation.

    Args:
        episodes: EPISODE (n,).
        worlds: WORLD (n,).
        fingers: FINGER (n, 2).
        columns: Output (n, 5), see `COLUMNS`.
    """
    for i in range(episodes.shape[0]):
        episode, world = episodes[i], worlds[i]
        time = episode.step * episode.step_time
        reference = trapezoid(time - episode.settle, episode.goal, episode.duration)
        for k in range(3):
            episode.reference[k] = reference[k]
        turned = -world.slip[2]
        error = turned - reference[0]
        slip = note_slip(episode, world)
        episode.dropped = detect_drop(episode, world, fingers[i])
        episode.success = (
            episode.step >= episode.steps
            and not episode.dropped
            and abs(turned - episode.goal) <= episode.tolerance
            and episode.largest_slip <= episode.slide_tolerance
        )
        terms = (
            math.exp(-((error / episode.tolerance) ** 2)),
            -min(slip / episode.slide_tolerance, 10.0),
            -effort(episode, fingers[i]),
            -roughness(episode),
            -1.0 if episode.dropped else 0.0,
        )
        for k in range(5):
            episode.terms[k] = episode.scales[k] * terms[k]
        for k in range(3):
            columns[i, k] = reference[k]
        columns[i, 3] = episode.goal
        columns[i, 4] = (episode.steps - episode.step) * episode.step_time


TASK = Task(
    id="slipgym/RotationalSlip-v0",
    key="rotational_slip",
    settings=Settings,
    defaults=DEFAULTS,
    options=Options,
    reward=REWARD,
    columns=COLUMNS,
    start=start,
    plan=plan,
    judge=judge,
    motion=Motion("turned by gravity", "rad", (0.0, 0.0, -1.0), goal="angle"),
    page=__doc__,
)
