"""Lift and carry an object that breaks in too firm a grip.

## Description

A parallel gripper holds a box that stands on a support. The support gives way, and the wrist lifts the box,
carries it sideways, turns it a little and shakes it. The box must not slip, and the grip must never exceed
the force at which it breaks.

That force is 1.5 to 2.5 times the least grip that holds the box through the episode: the ratio is known
(`allowance`), the force itself is not. It follows from mass and friction, which are unknown: the mass shows
in the load when the support gives way, and friction when it slips.

Friction decides this task. mu_c is drawn from 0.15 to 0.8, log-uniformly
(`tasks.fragile_hold.friction_range`; assumed), so that a grip which suits one end of the range breaks or
drops the box at the other. The force that breaks the box is not observed.

The least grip is that with which both pads stick, by the ellipsoidal limit surface: sqrt(f_x^2 + f_y^2 +
(tau / r)^2) / mu_s, at the largest load per finger of the episode. The load follows from the plan of the
wrist and from the disturbances, for a box that never slips, on the pads of the episode.

## Starting State

The box (0.2 to 0.5 kg) stands on the support, in a grip of `tasks.fragile_hold.initial_force` (1 N), which
is below every breaking force. For `settle` (0.4 s) the support bears all of its weight, a share that falls
to 0 linearly in `lift_off` (0.8 s).

After 0.15 s the wrist rises by `lift`, moves sideways by `travel` while it pitches by up to `sway` and back,
and makes three strokes of `stroke`, each as a minimum-jerk move. Sampled at random are mass, friction,
`allowance`, the ways and directions, and the largest acceleration of the moves. A wrist velocity that the
agent commands is added to the plan; the gripper's limits apply to the sum.

## Episode End

- Terminated: the box is dropped.
- Truncated: `duration` has passed (5 s, 600 control steps).

Success (`info["is_success"]`): the episode was played to its end, and the box was never dropped, never
slipped further than `tolerance` (1 mm) and never broke: the mean actuator force of both fingers stayed below
`allowance` times the least grip. A slip or a grip beyond that is the violation that `violated` reports.

## Info

| `reference` | force at which the box breaks, least grip that holds it, and 0, (3,) [N] |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np

from slipgym.config.base import NonNegative, Positive, PositiveInterval, ends_within
from slipgym.config.task import FrictionRange, InitialForce, MassRange, Option, TaskConfig, setting
from slipgym.tasks.carrying import PAUSE, WRIST_COLUMNS, rehearse, still, wrist_velocity, write_moves
from slipgym.tasks.episode import between, scratch, track_slip
from slipgym.tasks.least_grip import least_grip
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import Column, Task, term
from slipgym.tasks.terms import OUTCOME, TIME_LEFT, VIOLATED, effort, smoothness
from slipgym.world.actuator import mean_force

SCRATCH = scratch(allowance=1, acceleration=1)
"""`allowance`: breaking force over the least grip [-]; `acceleration`: largest of the plan, less gravity
[m/s^2]."""
_ALLOWANCE = Option(Positive, "Breaking force over the least grip [-]", {"ge": 1.0, "le": 100.0})
STROKES = 3
"""Strokes of the shaking at the end."""


class Settings(TaskConfig):
    """Settings of the fragile hold: the object must neither slip nor break while it is carried."""

    duration: Annotated[Positive, setting("Length of an episode", "s", reset=True, le=600.0)] = 5.0
    tolerance: Annotated[Positive, setting("Largest slip for success", "m", reset=True)] = 0.001
    allowance: Annotated[
        PositiveInterval,
        ends_within(1.0, 100.0),
        setting(
            "Breaking force over the least grip that holds the object, sampled from this range",
            "-",
            reset=_ALLOWANCE,
        ),
    ] = (1.5, 2.5)
    settle: Annotated[
        NonNegative, setting("Time in which the support bears the weight", "s", reset=True, le=60.0)
    ] = 0.4
    lift_off: Annotated[
        Positive, setting("Time in which the support gives way", "s", reset=True, le=60.0)
    ] = 0.8
    lift: Annotated[
        PositiveInterval, ends_within(1e-4, 1.0), setting("Height of the lift, sampled from this range", "m")
    ] = (0.05, 0.15)
    travel: Annotated[
        PositiveInterval,
        ends_within(1e-4, 1.0),
        setting("Way sideways, in either direction, sampled from this range", "m"),
    ] = (0.1, 0.25)
    sway: Annotated[NonNegative, setting("Largest pitch on that way", "rad", le=1.5)] = 0.2
    stroke: Annotated[Positive, setting("Length of a stroke of the shaking", "m", le=0.2)] = 0.02
    acceleration: Annotated[
        PositiveInterval,
        ends_within(1e-2, 100.0),
        setting("Largest acceleration of the moves, sampled from this range", "m/s^2"),
    ] = (1.0, 3.0)
    initial_force: InitialForce = 1.0
    mass_range: MassRange = (0.2, 0.5)
    friction_range: FrictionRange = (0.15, 0.8)


def start(settings: Settings, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row: sample the breaking force's ratio and the moves of the wrist."""
    shares = rng.random(7).tolist()  # drawn always, so that options do not shift later draws
    episode["tolerance"] = settings.tolerance
    episode["steps"] = max(1, round(settings.duration / episode["step_time"].item()))
    allowance = vars(options)["allowance"]
    episode["own"][SCRATCH.allowance] = allowance or between(settings.allowance, shares[0])
    time = settings.settle + settings.lift_off
    episode["support"][:2] = settings.settle, time
    time += PAUSE
    acceleration, speed = between(settings.acceleration, shares[1]), episode["wrist_speed_max"].item()
    side = 1.0 if shares[2] < 0.5 else -1.0
    pitch, heading = between((-settings.sway, settings.sway), shares[5]), math.pi * shares[6]
    ways = [
        (0.0, between(settings.lift, shares[3]), 0.0),
        (0.5 * side * between(settings.travel, shares[4]), 0.0, pitch),
    ]
    ways.append((ways[1][0], 0.0, -pitch))
    for k in range(STROKES):
        way = settings.stroke * (-1.0) ** k
        ways.append((way * math.cos(heading), way * math.sin(heading), 0.0))
    write_moves(episode, time, [(acceleration, way) for way in ways], speed)


def track(episode, world, fingers):
    """Compute the breaking force at the start, and store the largest slip."""
    if episode.step == 0:
        episode.least_grip, _, episode.own[SCRATCH.acceleration] = rehearse(episode, world, False)
        episode.grip_limit = episode.own[SCRATCH.allowance] * episode.least_grip
    episode.least_grip_now = least_grip(episode, world)
    episode.reference[0], episode.reference[1] = episode.grip_limit, episode.least_grip
    track_slip(episode, world)


def violated(episode, world, fingers):
    """Whether the object slid far or broke."""
    return episode.largest_slip > episode.tolerance or mean_force(fingers) > episode.grip_limit


@term(scale=0.3)
def gentle(episode, world, fingers):
    """1 while the grip is within the breaking force, else 0."""
    return 1.0 if mean_force(fingers) <= episode.grip_limit else 0.0


TASK = Task(
    id="slipgym/FragileHold-v0",
    settings=Settings,
    start=start,
    wrist_velocity=wrist_velocity,
    track=track,
    violated=violated,
    terms=(still, gentle, effort, smoothness, *OUTCOME),
    columns=(
        *WRIST_COLUMNS,
        Column("allowance", 0.0, 100.0, "-", "breaking force over the least grip that holds the object",
               f"episode.own[{SCRATCH.allowance}]"),
        Column("peak_acceleration", 0.0, 200.0, "m/s^2",
               "largest acceleration of the planned motion, less gravity",
               f"episode.own[{SCRATCH.acceleration}]"),
        TIME_LEFT,
        VIOLATED,
    ),
    motion=Motion(sign=0.0, body="bottle"),
    page=__doc__,
)  # fmt: skip
