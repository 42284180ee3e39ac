"""Pick an object up, swing it to another place and set it down, with an economical grip.

## Description

A parallel gripper holds a box that stands on a support. The support gives way, the wrist lifts the box,
swings it sideways and half of the way back, lowers it, and a support takes it over again. The wrist pitches
while it swings.

The box must not slip, and the grip must be economical: its mean over the episode may be at most `economy`
(1.6) times the mean of the least grip that holds the box. No constant grip does both. The grip has to follow
the load, which the plan of the wrist announces (its acceleration now and in 50, 100 and 200 ms is observed),
by a factor that depends on friction.

Mass and friction are unknown: the mass shows in the load when the support gives way, and friction when the
box slips.

The swing reaches 5 to 10 m/s^2 and 1.7 m/s, within the limits of a light arm such as Franka Emika's. mu_c is
drawn from 0.15 to 0.8, log-uniformly (`tasks.carry.friction_range`).

The least grip is defined as in [FragileHold](fragile_hold.md), for the load per finger at each time, and is
at least `gripper.force_min`.

## Rewards

The economy is an allowance for the whole episode. It is used up when the sum of the grip force reaches
`economy` times the sum of the least grip over the episode; success is impossible from then on.

## Starting State

The box (0.2 to 0.4 kg) stands on the support, in a grip of `tasks.carry.initial_force` (1 N). For `settle`
(0.3 s) the support bears all of its weight, a share that falls to 0 linearly in `lift_off` (0.8 s). After
0.15 s the wrist rises by `lift`, swings by `swing` and back by half of it while it pitches by up to `pitch`
and back, and sinks by `lift`, each as a minimum-jerk move.

After a short rest the support takes the box over, again in `lift_off`. Sampled at random are mass, friction,
ways and directions, and the largest acceleration of the swing. A wrist velocity that the agent commands is
added to the plan; the limit `wrist_speed` applies to the sum.

## Episode End

- Terminated: the box is dropped.
- Truncated: `duration` has passed (4.7 s, 564 control steps); the slowest plan takes 4.4 s.

Success (`info["is_success"]`): the episode was played to its end, and the box was never dropped, never
slipped further than `tolerance` (2 mm), and the mean grip was at most `economy` times the mean least grip. A
further slip and a larger sum of the grip are the violations that `violated` reports.

## Info

| `reference` | mean grip allowed, mean least grip, largest least grip, (3,) [N] |

## Version History

- v0: first version.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np

from slipgym.config.base import NonNegative, Positive, PositiveInterval, ends_within
from slipgym.config.task import FrictionRange, InitialForce, MassRange, TaskConfig, WristSpeed, setting
from slipgym.tasks.carrying import (
    PAUSE,
    WRIST_COLUMNS,
    planned_acceleration,
    rehearse,
    spend,
    still,
    still_wide,
    wrist_velocity,
    write_moves,
)
from slipgym.tasks.episode import between, scratch, track_slip
from slipgym.tasks.least_grip import least_grip
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import Column, Task, Value, term
from slipgym.tasks.terms import OUTCOME, TIME_LEFT, VIOLATED, smoothness
from slipgym.world.actuator import mean_force

SCRATCH = scratch(economy=1, mean=1)
"""`economy`: mean grip allowed over the mean least grip [-]; `mean`: mean least grip [N]."""
AHEAD = (0.0, 0.05, 0.1, 0.2)
"""Times ahead at which the plan is observed [s]."""
REST = 0.2
"""Rest between the last move and touch-down [s]."""


class Settings(TaskConfig):
    """Settings of the carry: the object is swung to another place without slip, in an economical grip."""

    duration: Annotated[Positive, setting("Length of an episode", "s", reset=True, le=600.0)] = 4.7
    tolerance: Annotated[Positive, setting("Largest slip for success", "m", reset=True)] = 0.002
    economy: Annotated[
        Positive,
        setting("Mean grip allowed for success, over the mean least grip", "-", reset=True, le=100.0),
    ] = 1.6
    settle: Annotated[
        NonNegative, setting("Time in which the support bears the weight", "s", reset=True, le=60.0)
    ] = 0.3
    lift_off: Annotated[
        Positive, setting("Time in which the support gives way", "s", reset=True, le=60.0)
    ] = 0.8
    lift: Annotated[
        PositiveInterval, ends_within(1e-4, 1.0), setting("Height of the lift, sampled from this range", "m")
    ] = (0.05, 0.1)
    lift_acceleration: Annotated[Positive, setting("Largest acceleration of the lift", "m/s^2", le=100.0)] = (
        3.0
    )
    swing: Annotated[
        PositiveInterval,
        ends_within(1e-4, 2.0),
        setting("Way of the swing, in either direction, sampled from this range", "m"),
    ] = (0.3, 0.5)
    pitch: Annotated[NonNegative, setting("Largest pitch on that way", "rad", le=1.5)] = 0.4
    acceleration: Annotated[
        PositiveInterval,
        ends_within(1e-2, 100.0),
        setting("Largest acceleration of the swing, sampled from this range", "m/s^2", reset=True),
    ] = (5.0, 10.0)
    initial_force: InitialForce = 1.0
    mass_range: MassRange = (0.2, 0.4)
    friction_range: FrictionRange = (0.15, 0.8)
    wrist_speed: WristSpeed = 1.7


def start(settings: Settings, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row: sample the moves of the wrist."""
    shares = rng.random(5).tolist()
    episode["tolerance"], episode["own"][SCRATCH.economy] = settings.tolerance, settings.economy
    time = settings.settle + settings.lift_off
    episode["support"][:2] = settings.settle, time
    time += PAUSE
    acceleration, speed = between(settings.acceleration, shares[0]), episode["wrist_speed_max"].item()
    lift, side = between(settings.lift, shares[1]), 1.0 if shares[2] < 0.5 else -1.0
    swing = side * between(settings.swing, shares[3])
    pitch = between((-settings.pitch, settings.pitch), shares[4])
    gentle = settings.lift_acceleration
    moves = (
        (gentle, (0.0, lift, 0.0)),
        (acceleration, (swing, 0.0, pitch)),
        (acceleration, (-0.5 * swing, 0.0, -pitch)),
        (gentle, (0.0, -lift, 0.0)),
    )
    time = write_moves(episode, time, moves, speed) + REST
    episode["support"][2:] = time, time + settings.lift_off
    episode["steps"] = max(1, round(settings.duration / episode["step_time"].item()))


def track(episode, world, fingers):
    """Compute the least grip at the start, add up the grip, and store the largest slip."""
    own = episode.own
    if episode.step == 0:
        episode.least_grip, own[SCRATCH.mean], _ = rehearse(episode, world, True)
        episode.grip_limit = own[SCRATCH.economy] * own[SCRATCH.mean]
        episode.grip_budget = episode.steps * episode.grip_limit
    episode.least_grip_now = least_grip(episode, world)
    episode.reference[0], episode.reference[1] = episode.grip_limit, own[SCRATCH.mean]
    episode.reference[2] = episode.least_grip
    spend(episode, fingers)
    track_slip(episode, world)


def violated(episode, world, fingers):
    """Whether the object slid far, or the grip has used up what the economy allows."""
    return episode.largest_slip > episode.tolerance or episode.grip_sum > episode.grip_budget


@term(scale=0.3)
def thrift(episode, world, fingers):
    """-(mean actuator force) / (4 times the mean least grip)."""
    return -mean_force(fingers) / max(4.0 * episode.own[SCRATCH.mean], 1e-9)


@term(scale=0.0)
def overgrip(episode, world, fingers):
    """-(mean actuator force / (economy times the least grip now) - 1), 0 for a smaller force."""
    least = max(episode.least_grip_now, episode.force_min)
    return -max(0.0, mean_force(fingers) / (episode.own[SCRATCH.economy] * least) - 1.0)


def _ahead(time: float, axis: int) -> Value:
    """Function that reads the planned acceleration along an axis, a time ahead [s]."""

    def read(episode, world, fingers):
        return planned_acceleration(episode, time, axis)

    return read


def _plan() -> tuple[Column, ...]:
    """The planned acceleration, now and ahead."""
    axes = (
        ("x", "m/s^2", 100.0, "along world x"),
        ("z", "m/s^2", 100.0, "along world z"),
        ("pitch", "rad/s^2", 500.0, "in pitch"),
    )
    found = []
    for time in AHEAD:
        when = f"in {1e3 * time:.0f} ms" if time else "in the coming control step"
        for axis, (name, unit, most, along) in enumerate(axes):
            label = f"planned_acceleration_{name}_{1e3 * time:.0f}"
            meaning = f"planned acceleration of the wrist {along}, {when}"
            found.append(Column(label, -most, most, unit, meaning, _ahead(time, axis)))
    return tuple(found)


TASK = Task(
    id="slipgym/Carry-v0",
    settings=Settings,
    start=start,
    wrist_velocity=wrist_velocity,
    track=track,
    violated=violated,
    terms=(still, thrift, smoothness, *OUTCOME, still_wide, overgrip),
    columns=(*WRIST_COLUMNS, *_plan(), TIME_LEFT, VIOLATED),
    motion=Motion(sign=0.0),
    page=__doc__,
)
