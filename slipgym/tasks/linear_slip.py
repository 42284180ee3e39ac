"""Let the object slide a given distance along gravity in a given time, then hold it.

## Description

A parallel gripper on a wrist at rest holds a box from both sides. It must loosen its grip just so far
that the box slides down between the pads along a trapezoidal reference, and then tighten it so that the
box stays. Friction is not known beforehand: an estimator works it out from force, torque and slip
velocity while the box slides. After the linear slip of Waltersson and Karayiannidis (arXiv 2507.06824 and
arXiv 2410.19660).

## Starting State

The box hangs still in a grip of `tasks.linear_slip.initial_force` (15 N), its grasp point between the
pads. The material is drawn if `material` is "random", and so are the sensors' biases and the fractions of
a count that the slip sensors begin with. Grip and sensors run for six samples before time 0.

## Episode End

- Terminated: the box is dropped, that is, neither pad touches it or a pad reaches beyond its edge.
- Truncated: `settle` + `duration` + `hold` have passed (0.5 s + 5 s + 1 s, 780 samples). The environment
  truncates by itself; no `TimeLimit` is needed.

Success (`info["is_success"]`): at the end of the last sample the distance slid is within `tolerance` (2
mm) of `distance`, and the box was not dropped.

## Info

| `reference` | distance to have slid, its rate and second rate, (3,) [m, m/s, m/s^2] |

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
from slipgym.tasks.episode import detect_drop, drive_wrist, effort, roughness, schedule, trapezoid
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import DROP, EFFORT, SMOOTHNESS, Column, Task, Term


class Settings(TaskConfig):
    """The object slides down between the pads by a given distance in a given time, then stays."""

    distance: Positive = Field(description="Distance to slide [m]")
    duration: Positive = Field(description="Time for the slide [s]")
    settle: NonNegative = Field(description="Time before the slide, during which the object is held [s]")
    hold: NonNegative = Field(description="Time after the slide, during which the object is held [s]")
    tolerance: Positive = Field(description="Largest error of the final position for success [m]")


DEFAULTS = {
    "distance": 0.04,
    "duration": 5.0,
    "settle": 0.5,
    "hold": 1.0,
    "tolerance": 0.002,
    "initial_force": 15.0,
}
REWARD = (
    Term("tracking", 1.0, "exp(-(e / tolerance)^2), e = distance slid less the reference's"),
    Term("sideways", 0.1, "-(abs(x) + gripper.pad_radius abs(theta)) / tolerance, at least -10"),
    Term("effort", 0.1, EFFORT),
    Term("smoothness", 0.1, SMOOTHNESS),
    Term("drop", 100.0, DROP),
)
COLUMNS = (
    Column("reference_position", 0.0, 1.0, "m", "distance the object should have slid"),
    Column("reference_velocity", 0.0, 1.0, "m/s", "its rate"),
    Column("reference_acceleration", -5.0, 5.0, "m/s^2", "its second rate"),
    Column("distance", 0.0, 1.0, "m", "distance to slide in the episode"),
    Column("time_left", 0.0, 1000.0, "s", "time until the episode ends"),
)


class Options(EpisodeOptions):
    """What `reset(options=...)` can fix."""

    distance: Positive | None = Field(default=None, le=0.2, description="Distance to slide [m]")
    duration: Positive | None = Field(default=None, le=120.0, description="Time for the slide [s]")
    settle: NonNegative | None = Field(default=None, le=60.0, description="Time held before the slide [s]")
    hold: NonNegative | None = Field(default=None, le=60.0, description="Time held after the slide [s]")
    tolerance: Positive | None = Field(default=None, description="Largest final error for success [m]")


def start(config: Config, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; nothing here is drawn at random."""
    task = config.tasks.linear_slip
    episode["goal"] = options.choose("distance", task)
    episode["tolerance"] = options.choose("tolerance", task)
    schedule(options, task, episode)


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
        error = -world.slip[1] - reference[0]
        sideways = abs(world.slip[0]) + episode.pad_radius * abs(world.slip[2])
        episode.dropped = detect_drop(episode, world, fingers[i])
        final = -world.slip[1] - episode.goal
        episode.success = (
            episode.step >= episode.steps and not episode.dropped and abs(final) <= episode.tolerance
        )
        terms = (
            math.exp(-((error / episode.tolerance) ** 2)),
            -min(sideways / episode.tolerance, 10.0),
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
    id="slipgym/LinearSlip-v0",
    key="linear_slip",
    settings=Settings,
    defaults=DEFAULTS,
    options=Options,
    reward=REWARD,
    columns=COLUMNS,
    start=start,
    plan=plan,
    judge=judge,
    motion=Motion("slid down", axis=(0.0, -1.0, 0.0), goal="distance"),
    page=__doc__,
)
