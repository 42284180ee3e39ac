"""Hold an object of unknown mass and friction while the wrist shakes and pokes disturb it.

## Description

A parallel gripper holds a box from both sides. The wrist oscillates along x and z and in pitch, and short
pushes act on the box. The box must not slip, and the grip force should be as small as possible. Mass and
friction are unknown. The task follows the holding task of Waltersson and Karayiannidis (arXiv 2410.19660).

By default a firm grip solves every episode. With `grip_limit` success asks for an economical grip, too: the
mean grip may be at most `grip_limit` times the least grip, the smallest constant one with which both pads
stick, sqrt(f_x^2 + f_y^2 + (tau / r)^2) / mu_s by the ellipsoidal limit surface, on the pads of the episode.

The mean counts the whole episode: shaking, pushes, and falls of friction and changes of mass within it;
friction that varies over the surface is left out. `grip_limit_start` leaves the beginning out of the mean,
so that a policy can find friction out. The mean counts, and not the peak, so that the grip may answer a push
for a moment. Neither the least grip nor the mean allowed is observed. The levels "standard" and "hard" set
`grip_limit`, to 1.75 and 1.4.

## Starting State

The box hangs at rest in a grip of `tasks.hold.initial_force` (15 N), its grasp point between the pads.
Sampled at random are its mass (0.1 to 0.4 kg), the wrist's frequencies (1 to 3 Hz) and phases, the pushes
(impulse, direction, lever and time; ranges in `tasks.hold`). The oscillation builds up over 0.5 s. A wrist
velocity that the agent commands is added to it; the gripper's limits apply to the sum.

## Episode End

- Terminated: the box is dropped.
- Truncated: `duration` has passed (8 s, 960 control steps).

Success (`info["is_success"]`): the episode was played to its end, and the box was never dropped and never
slipped further than `tolerance` (2 mm); with `grip_limit`, the mean actuator force of both fingers from
`grip_limit_start` (1 s) to the end was also at most `grip_limit` times the least grip. A slip further than
the tolerance is the violation that `violated` reports, and so is a grip whose sum over the control steps
exceeds what the whole episode allows.

## Info

| `reference` | with `grip_limit` the mean grip allowed, least grip, and 0, (3,) [N]; else zeros |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config.base import Interval, NonNegative, Positive, PositiveInterval, ends_within
from slipgym.config.task import MassRange, TaskConfig, setting
from slipgym.tasks.carrying import WRIST_COLUMNS, rehearse, spend, still, still_wide
from slipgym.tasks.disturbance import POKES_MAX, add_push
from slipgym.tasks.episode import between, scratch, track_slip, whole_steps
from slipgym.tasks.least_grip import least_grip
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import Task, term
from slipgym.tasks.terms import OUTCOME, TIME_LEFT, VIOLATED, effort, smoothness
from slipgym.world.actuator import mean_force

SCRATCH = scratch(ratio=1)
"""`ratio`: mean grip allowed over the least grip, 0: any is allowed [-]."""


class Settings(TaskConfig):
    """Settings of the hold: the object must stay in the grip while the wrist shakes and pushes act on it."""

    duration: Annotated[Positive, setting("Length of an episode", "s", reset=True, le=600.0)] = 8.0
    tolerance: Annotated[Positive, setting("Largest slip for success", "m", reset=True)] = 0.002
    mass_range: MassRange = (0.1, 0.4)
    shake_amplitude: Annotated[
        NonNegative, setting("Amplitude of the wrist's shaking along x and z", "m", reset=True, le=0.05)
    ] = 0.004
    shake_pitch: Annotated[
        NonNegative, setting("Amplitude of the wrist's shaking in pitch", "rad", reset=True, le=0.5)
    ] = 0.03
    shake_frequency: Annotated[
        PositiveInterval,
        ends_within(1e-3, 50.0),
        setting("The shaking's frequency is sampled from this range", "Hz", reset=True),
    ] = (1.0, 3.0)
    poke_impulse: Annotated[
        Interval,
        ends_within(0.0, 100.0),
        setting("The impulse of a poke is sampled from this range", "N s", reset=True),
    ] = (0.01, 0.05)
    poke_offset: Annotated[
        NonNegative, setting("Largest lever of a poke about the centre of mass", "m", le=1.0)
    ] = 0.02
    poke_interval: Annotated[
        PositiveInterval,
        ends_within(1e-3, 1e4),
        setting("The time between pokes is sampled from this range", "s", reset=True),
    ] = (0.8, 1.6)
    poke_duration: Annotated[Positive, setting("Length of a poke", "s", le=10.0)] = 0.02
    grip_limit: Annotated[
        Positive | None,
        setting(
            "Mean grip allowed for success, over the least grip that holds the object; null: any",
            "-",
            reset=True,
            ge=1.0,
            le=100.0,
        ),
    ] = None
    grip_limit_start: Annotated[
        NonNegative, setting("Time from which the grip counts for `grip_limit`", "s", reset=True, le=600.0)
    ] = 1.0


def start(settings: Settings, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row: sample the shaking and the pokes."""
    episode["tolerance"] = settings.tolerance
    episode["own"][SCRATCH.ratio] = settings.grip_limit or 0.0
    amplitudes = settings.shake_amplitude, settings.shake_amplitude, settings.shake_pitch
    offsets = -settings.poke_offset, settings.poke_offset
    times = settings.duration, settings.poke_duration
    ranges = settings.shake_frequency, settings.poke_interval, settings.poke_impulse, offsets
    disturb_hold(rng.random(6 + 4 * POKES_MAX), amplitudes, ranges, times, episode)
    begin = round(settings.grip_limit_start / episode["step_time"].item())
    episode["grip_counted"] = min(begin, episode["steps"].item())


@compiled
def disturb_hold(shares, amplitudes, ranges, times, episode):
    """Write the length of an episode, the wrist's shaking and the pokes that begin within it.

    Args:
        shares: Uniform random numbers in [0, 1): of three frequencies, three phases, and `POKES_MAX` gaps
            before pokes, headings, impulses and levers.
        amplitudes: Of the shaking along x, z and in pitch [m, m, rad].
        ranges: Ends of the frequencies [Hz], gaps [s], impulses [N s] and levers [m].
        times: Length of the episode and of a poke [s].
        episode: EPISODE record.
    """
    frequencies, gaps, impulses, levers = ranges
    dt = episode.step_time
    episode.steps, steps = max(1, whole_steps(times[0], dt)), max(1, whole_steps(times[1], dt))
    for axis in range(3):
        episode.shakes[0, axis, 0] = amplitudes[axis]
        episode.shakes[0, axis, 1] = 2.0 * math.pi * between(frequencies, shares[axis])
        episode.shakes[0, axis, 2] = between((0.0, 2.0 * math.pi), shares[3 + axis])
    pokes = shares[6:].reshape(4, POKES_MAX)
    time = 0.0
    for k in range(POKES_MAX):
        time += between(gaps, pokes[0, k])
        begin = whole_steps(time, dt)
        if begin >= episode.steps:
            break
        heading, impulse = between((0.0, 2.0 * math.pi), pokes[1, k]), between(impulses, pokes[2, k])
        add_push(episode, begin, steps, impulse, heading, between(levers, pokes[3, k]))


def track(episode, world, fingers):
    """Compute the least grip at the start, add up the grip if it is limited, and store the largest slip."""
    ratio = episode.own[SCRATCH.ratio]
    if ratio > 0.0:
        if episode.step == 0:
            episode.least_grip, _, _ = rehearse(episode, world, False)
            episode.grip_limit = ratio * episode.least_grip
            episode.grip_budget = (episode.steps - episode.grip_counted) * episode.grip_limit
        episode.least_grip_now = least_grip(episode, world)
        spend(episode, fingers)
    episode.reference[0], episode.reference[1] = episode.grip_limit, episode.least_grip
    track_slip(episode, world)


def violated(episode, world, fingers):
    """Whether the object slid far, or the grip has used up what `grip_limit` allows."""
    spent = episode.grip_sum > episode.grip_budget  # both 0 without `grip_limit`
    return episode.largest_slip > episode.tolerance or spent


@term(scale=0.0)
def overgrip(episode, world, fingers):
    """-(mean actuator force / (grip_limit times the least grip) - 1), 0 for a smaller one or without it."""
    if episode.grip_limit == 0.0:
        return 0.0
    return -max(0.0, mean_force(fingers) / episode.grip_limit - 1.0)


TASK = Task(
    id="slipgym/Hold-v0",
    settings=Settings,
    start=start,
    track=track,
    violated=violated,
    terms=(still, effort._replace(scale=0.5), smoothness, *OUTCOME, still_wide, overgrip),
    columns=(*WRIST_COLUMNS, TIME_LEFT, VIOLATED),
    motion=Motion(sign=0.0, body="bottle"),
    page=__doc__,
)  # fmt: skip
