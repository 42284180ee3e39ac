"""Hold an object of unknown mass and friction while the wrist shakes and pokes disturb it.

## Description

A parallel gripper holds a box from both sides. The wrist moves up and down, to and fro, and pitches; now
and then something pokes the box. It must not slip, yet be gripped no harder than needed. Neither mass nor
friction is known beforehand: an estimator works friction out from force, torque and slip velocity, as far
as the box slips at all. After the holding task of Waltersson and Karayiannidis (arXiv 2410.19660).

## Starting State

The box hangs still in a grip of `tasks.hold.initial_force` (15 N), its grasp point between the pads. Its
mass is drawn from 0.1 to 0.4 kg, the wrist's frequencies (1 to 3 Hz) and phases and the pokes (impulse,
direction, lever and time) from the ranges in `tasks.hold`; so are the material, if `material` is
"random", the sensors' biases and the fractions of a count that the slip sensors begin with. Grip and
sensors run for six samples before time 0; the shaking builds up over 0.5 s. A wrist velocity that the
agent commands adds to it; the sum stays within the gripper's limits.

## Episode End

- Terminated: the box is dropped, that is, neither pad touches it or a pad reaches beyond its edge.
- Truncated: `duration` has passed (8 s, 960 samples). The environment truncates by itself; no `TimeLimit`
  is needed.

Success (`info["is_success"]`): the episode was played to its end, and the box was never dropped and never
slipped further than `tolerance` (2 mm).

## Info

| `reference` | zeros, (3,) |

## Version History

- v0: first version.
"""

from __future__ import annotations

import math

import numpy as np
from pydantic import Field

from slipgym._numba.compiled import compiled
from slipgym.config import Config, TaskConfig
from slipgym.config.base import Interval, NonNegative, Positive, PositiveInterval
from slipgym.tasks.disturbance import POKES_MAX
from slipgym.tasks.episode import detect_drop, drive_wrist, effort, note_slip, roughness
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import DROP, EFFORT, SMOOTHNESS, Column, Task, Term


class Settings(TaskConfig):
    """The object is to stay in the grip while the wrist shakes and something pokes the object."""

    duration: Positive = Field(description="Length of an episode [s]")
    tolerance: Positive = Field(description="Largest slip for success [m]")
    shake_amplitude: NonNegative = Field(description="Amplitude of the wrist's shaking along x and z [m]")
    shake_pitch: NonNegative = Field(description="Amplitude of the wrist's shaking in pitch [rad]")
    shake_frequency: PositiveInterval = Field(
        description="The shaking's frequency is drawn from this range [Hz]"
    )
    poke_impulse: Interval = Field(description="The impulse of a poke is drawn from this range [N s]")
    poke_offset: NonNegative = Field(description="Lever of a poke about the centre of mass, at most [m]")
    poke_interval: PositiveInterval = Field(description="The time between pokes is drawn from this range [s]")
    poke_duration: Positive = Field(description="Length of a poke [s]")


DEFAULTS = {
    "duration": 8.0,
    "tolerance": 0.002,
    "mass_range": [0.1, 0.4],
    "initial_force": 15.0,
    "shake_amplitude": 0.004,
    "shake_pitch": 0.03,
    "shake_frequency": [1.0, 3.0],
    "poke_impulse": [0.01, 0.05],
    "poke_offset": 0.02,
    "poke_interval": [0.8, 1.6],
    "poke_duration": 0.02,
}
REWARD = (
    Term("still", 1.0, "exp(-(s / tolerance)^2), s = slip displacement at the pad centre"),
    Term("effort", 1.0, EFFORT),
    Term("smoothness", 0.1, SMOOTHNESS),
    Term("drop", 100.0, DROP),
)
COLUMNS = (
    Column("wrist_velocity_x", -2.0, 2.0, "m/s", "commanded wrist velocity along world x"),
    Column("wrist_velocity_z", -2.0, 2.0, "m/s", "commanded wrist velocity along world z"),
    Column("wrist_pitch_rate", -10.0, 10.0, "rad/s", "commanded wrist pitch rate"),
    Column("time_left", 0.0, 1000.0, "s", "time until the episode ends"),
)


class Options(EpisodeOptions):
    """What `reset(options=...)` can fix."""

    duration: Positive | None = Field(default=None, le=600.0, description="Length of the episode [s]")
    tolerance: Positive | None = Field(default=None, description="Largest slip for success [m]")
    shake_amplitude: NonNegative | None = Field(
        default=None, le=0.05, description="Amplitude of the wrist's shaking along x and z [m]"
    )
    shake_pitch: NonNegative | None = Field(default=None, le=0.5, description="Its amplitude in pitch [rad]")
    shake_frequency: PositiveInterval | None = Field(default=None, description="Range of its frequency [Hz]")
    poke_impulse: Interval | None = Field(default=None, description="Range of a poke's impulse [N s]")
    poke_interval: PositiveInterval | None = Field(default=None, description="Range of their distance [s]")


def start(config: Config, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row: draw the shaking and the pokes."""
    task = config.tasks.hold
    dt = float(episode["step_time"])
    episode["tolerance"] = options.choose("tolerance", task)
    episode["steps"] = max(1, round(options.choose("duration", task) / dt))
    amplitude, pitch = options.choose("shake_amplitude", task), options.choose("shake_pitch", task)
    frequency = rng.uniform(*options.choose("shake_frequency", task), size=3)
    phase = rng.uniform(0.0, 2.0 * math.pi, 3)
    episode["shakes"][0] = np.column_stack(([amplitude, amplitude, pitch], 2.0 * math.pi * frequency, phase))
    _draw_pokes(config, options, rng, episode)


def _draw_pokes(config: Config, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    task = config.tasks.hold
    dt = float(episode["step_time"])
    steps = max(1, round(task.poke_duration / dt))
    impulse = np.asarray(options.choose("poke_impulse", task))
    gaps = rng.uniform(*options.choose("poke_interval", task), size=POKES_MAX)
    begin = np.rint(np.cumsum(gaps) / dt).astype(np.int64)
    heading = rng.uniform(0.0, 2.0 * math.pi, POKES_MAX)
    size = rng.uniform(*impulse, size=POKES_MAX) / (steps * dt)
    lever = rng.uniform(-task.poke_offset, task.poke_offset, POKES_MAX)
    wrench = np.column_stack((size * np.cos(heading), size * np.sin(heading), size * lever))
    n = episode["pushes"] = np.count_nonzero(begin < episode["steps"])
    episode["push_start"][:n] = begin[:n]
    episode["push_end"][:n] = begin[:n] + steps
    episode["push_wrench"][:n] = wrench[:n]


@compiled
def plan(episodes, worlds):
    """Before a control step: the wrist is shaken, and moves as the agent commands."""
    for i in range(episodes.shape[0]):
        drive_wrist(episodes[i], worlds[i], 0.0, 0.0, 0.0)


@compiled
def judge(episodes, worlds, fingers, columns):
    """After a control step: reward terms, outcome, observation.

    Args:
        episodes: EPISODE (n,).
        worlds: WORLD (n,).
        fingers: FINGER (n, 2).
        columns: Output (n, 4), see `COLUMNS`.
    """
    for i in range(episodes.shape[0]):
        episode, world = episodes[i], worlds[i]
        slip = note_slip(episode, world)
        episode.dropped = detect_drop(episode, world, fingers[i])
        finished = episode.step >= episode.steps and not episode.dropped
        episode.success = finished and episode.largest_slip <= episode.tolerance
        terms = (
            math.exp(-((slip / episode.tolerance) ** 2)),
            -effort(episode, fingers[i]),
            -roughness(episode),
            -1.0 if episode.dropped else 0.0,
        )
        for k in range(4):
            episode.terms[k] = episode.scales[k] * terms[k]
        for k in range(3):
            columns[i, k] = world.wrist_velocity[k]
        columns[i, 3] = (episode.steps - episode.step) * episode.step_time


TASK = Task(
    id="slipgym/Hold-v0",
    key="hold",
    settings=Settings,
    defaults=DEFAULTS,
    options=Options,
    reward=REWARD,
    columns=COLUMNS,
    start=start,
    plan=plan,
    judge=judge,
    page=__doc__,
)
