"""Let gravity turn the object about the grip axis by a given angle in a given time, without sliding.

## Description

A parallel gripper on a wrist at rest holds a bar near one end. The agent reduces the grip force so that the
bar's weight turns it between the pads along a trapezoidal reference, and then increases it so that the bar
stops. The task follows the rotational slip of Waltersson and Karayiannidis (arXiv 2410.19660).

Some sliding is inevitable. The slip twist is normal to the limit surface at the load, v_t / omega = r^2 f_t
/ tau, and tau / f_t is the weight's lever d cos(tilt). A turn from -angle/2 to +angle/2 about horizontal
therefore slides 2 (r^2 / d) ln tan(45 deg + angle/4). With r = 10 mm and d = 180 mm this is 0.61 mm at 60
deg, whatever the controller does.

On a disc (`contact="distributed"`) it is 3/2 as much. Holding the bar level takes m g d / (2 mu_c r) per
finger. The task therefore has its own light and long object (`tasks.rotational_slip.object`): 0.06 kg,
460 mm by 40 mm, gripped 180 mm from its centre, which takes 15 N at mu_c 0.36.

## Starting State

The bar is held at rest in a grip of `tasks.rotational_slip.initial_force` (25 N), its grasp point between
the pads and the bar aligned with them. The wrist is pitched by angle/2 with the bar's heavy end up, so that
the turn is symmetric about horizontal. The bar turns clockwise: theta decreases. The reference rests for
`settle` (0.5 s), turns by `angle` (60 deg) in `duration` (5 s), and rests for `hold` (1 s).

## Episode End

- Terminated: the bar is dropped.
- Truncated: settle + duration + hold have passed (6.5 s, 780 control steps).

Success (`info["is_success"]`): the episode was played to its end, the bar is not dropped, -theta is `angle`
within `tolerance` (2 deg), and it never slid further than `slide_tolerance` (1 mm) at the pad centre. A
slide further than that is the violation that `violated` reports.

## Info

| `reference` | angle, angular velocity and acceleration of the reference, (3,) [rad, rad/s, rad/s^2] |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np

from slipgym.config.base import NonNegative, Positive
from slipgym.config.hardware import ObjectConfig
from slipgym.config.task import InitialForce, TaskConfig, TaskObject, setting
from slipgym.tasks.episode import follow_trapezoid, schedule, track_slip
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import Column, Task, term
from slipgym.tasks.terms import OUTCOME, TIME_LEFT, VIOLATED, effort, sliding, smoothness

WIDTH = 0.2
"""Width of `tracking_wide` [rad]."""


class Settings(TaskConfig):
    """Settings of the rotational slip: the object turns by a given angle in a given time, then stops."""

    angle: Annotated[Positive, setting("Angle to turn", "rad", reset=True, le=1.6)] = 1.0472  # 60 degrees
    duration: Annotated[Positive, setting("Time for the turn", "s", reset=True, le=120.0)] = 5.0
    settle: Annotated[NonNegative, setting("Time held before the turn", "s", reset=True, le=60.0)] = 0.5
    hold: Annotated[NonNegative, setting("Time held after the turn", "s", reset=True, le=60.0)] = 1.0
    tolerance: Annotated[Positive, setting("Largest final error for success", "rad", reset=True)] = 0.0349
    slide_tolerance: Annotated[Positive, setting("Largest slip for success", "m", reset=True)] = 0.001
    initial_force: InitialForce = 25.0
    object: TaskObject = ObjectConfig(  # light and long: see docs/environments/rotational_slip.md
        mass=0.06, size=(0.46, 0.03, 0.04), com_offset=(0.0, 0.0), inertia=None, grasp_offset=(-0.18, 0.0)
    )


def start(settings: Settings, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; nothing here is drawn at random.

    The wrist starts pitched by half the angle, so that the turn is symmetric about horizontal.
    """
    episode["goal"] = settings.angle
    episode["tolerance"], episode["slide_tolerance"] = settings.tolerance, settings.slide_tolerance
    schedule(settings, episode)
    episode["wrist_start"] = 0.0, 0.0, 0.5 * episode["goal"]


def track(episode, world, fingers):
    """Update the reference, and store the largest slip."""
    follow_trapezoid(episode)
    track_slip(episode, world)


def success(episode, world):
    """Whether the object turned by the given angle."""
    return abs(-world.slip[2] - episode.goal) <= episode.tolerance


def violated(episode, world, fingers):
    """Whether the object slid far."""
    return episode.largest_slip > episode.slide_tolerance


@term(scale=1.0)
def tracking(episode, world, fingers):
    """exp(-(e / tolerance)^2), e = -theta - reference."""
    error = -world.slip[2] - episode.reference[0]
    return math.exp(-((error / episode.tolerance) ** 2))


@term(scale=0.0)
def tracking_wide(episode, world, fingers):
    """exp(-(e / 0.2 rad)^2), the same e: it has a slope where `tracking` is 0."""
    return math.exp(-(((-world.slip[2] - episode.reference[0]) / WIDTH) ** 2))


TASK = Task(
    id="slipgym/RotationalSlip-v0",
    settings=Settings,
    start=start,
    track=track,
    success=success,
    violated=violated,
    terms=(tracking, sliding, effort, smoothness, *OUTCOME, tracking_wide),
    columns=(
        Column("reference_position", 0.0, 2.0, "rad", "angle the object should have turned, clockwise",
               "episode.reference[0]"),
        Column("reference_velocity", 0.0, 10.0, "rad/s", "its rate", "episode.reference[1]"),
        Column("reference_acceleration", -100.0, 100.0, "rad/s^2", "its second rate", "episode.reference[2]"),
        Column("angle", 0.0, 2.0, "rad", "angle to turn in the episode", "episode.goal"),
        TIME_LEFT,
        VIOLATED,
    ),
    motion=Motion("turned by gravity", "rad", (0.0, 0.0, -1.0), goal="angle", body="tool",
                  end=lambda episode: (0.0, 0.0, -float(episode["goal"]))),
    page=__doc__,
)  # fmt: skip
