"""Let the object slide a given distance along gravity in a given time, then hold it.

## Description

A parallel gripper on a wrist at rest holds a box from both sides. The agent reduces the grip force so that
the box slides down between the pads along a trapezoidal reference, and then increases it so that the box
stops. The task follows the linear slip of Waltersson and Karayiannidis (arXiv 2507.06824 and arXiv
2410.19660).

## Starting State

The box hangs at rest in a grip of `tasks.linear_slip.initial_force` (15 N), its grasp point between the
pads.

## Episode End

- Terminated: the box is dropped.
- Truncated: `settle` + `duration` + `hold` have passed (0.5 s + 5 s + 1 s, 780 control steps).

Success (`info["is_success"]`): at the end of the last step the distance slid is within `tolerance` (2 mm) of
`distance`, and the box was not dropped. Nothing before the end makes it impossible: `violated` is always 0.

## Info

| `reference` | reference distance, its velocity and acceleration, (3,) [m, m/s, m/s^2] |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np

from slipgym.config.base import NonNegative, Positive
from slipgym.config.task import TaskConfig, setting
from slipgym.tasks.episode import follow_trapezoid, schedule
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import Column, Task, term
from slipgym.tasks.terms import TIME_LEFT, VIOLATED, drop, effort, smoothness, solved


class Settings(TaskConfig):
    """Settings of the linear slip: the object slides down by a given distance in a given time, then stops."""

    distance: Annotated[Positive, setting("Distance to slide", "m", reset=True, le=0.2)] = 0.04
    duration: Annotated[Positive, setting("Time for the slide", "s", reset=True, le=120.0)] = 5.0
    settle: Annotated[NonNegative, setting("Time held before the slide", "s", reset=True, le=60.0)] = 0.5
    hold: Annotated[NonNegative, setting("Time held after the slide", "s", reset=True, le=60.0)] = 1.0
    tolerance: Annotated[Positive, setting("Largest final error for success", "m", reset=True)] = 0.002


def start(settings: Settings, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; nothing here is drawn at random."""
    episode["goal"], episode["tolerance"] = settings.distance, settings.tolerance
    schedule(settings, episode)


def track(episode, world, fingers):
    """Update the reference."""
    follow_trapezoid(episode)


def success(episode, world):
    """Whether the object slid the given distance."""
    return abs(-world.slip[1] - episode.goal) <= episode.tolerance


@term(scale=1.0)
def tracking(episode, world, fingers):
    """exp(-(e / tolerance)^2), e = distance slid less the reference's."""
    error = -world.slip[1] - episode.reference[0]
    return math.exp(-((error / episode.tolerance) ** 2))


@term(scale=0.5)
def sideways(episode, world, fingers):
    """-(abs(x) + gripper.pad_radius abs(theta)) / (10 tolerance)."""
    away = abs(world.slip[0]) + episode.pad_radius * abs(world.slip[2])
    return -away / (10.0 * episode.tolerance)


TASK = Task(
    id="slipgym/LinearSlip-v0",
    settings=Settings,
    start=start,
    track=track,
    success=success,
    terms=(tracking, sideways, effort, smoothness, solved, drop),
    columns=(
        Column("reference_position", 0.0, 1.0, "m", "distance the object should have slid",
               "episode.reference[0]"),
        Column("reference_velocity", 0.0, 1.0, "m/s", "its rate", "episode.reference[1]"),
        Column("reference_acceleration", -5.0, 5.0, "m/s^2", "its second rate", "episode.reference[2]"),
        Column("distance", 0.0, 1.0, "m", "distance to slide in the episode", "episode.goal"),
        TIME_LEFT,
        VIOLATED,
    ),
    motion=Motion("slid down", axis=(0.0, -1.0, 0.0), goal="distance",
                  end=lambda episode: (0.0, -float(episode["goal"]), 0.0)),
    page=__doc__,
)  # fmt: skip
