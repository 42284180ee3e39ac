"""Hold: keep an object of unknown mass and friction while the wrist shakes and pokes disturb it."""

from __future__ import annotations

import math

import numpy as np
from pydantic import Field

from slipgym.compiled import compiled
from slipgym.config import Config
from slipgym.config.base import Interval, NonNegative, Positive, PositiveInterval
from slipgym.tasks.episode import POKES_MAX, detect_drop, drive_wrist, effort, note_slip, roughness
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import Column, Task

TERMS = ("still", "effort", "smoothness", "drop")
COLUMNS = (
    Column("wrist_velocity_x", -2.0, 2.0, "m/s", "commanded wrist velocity along world x"),
    Column("wrist_velocity_z", -2.0, 2.0, "m/s", "commanded wrist velocity along world z"),
    Column("wrist_pitch_rate", -10.0, 10.0, "rad/s", "commanded wrist pitch rate"),
    Column("time_left", 0.0, 1000.0, "s", "time until the episode ends"),
)
_SHAKE_RISE = 0.5  # [s] over which the shaking builds up, so that it starts without a jerk


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
    episode["shake"] = np.column_stack(([amplitude, amplitude, pitch], 2.0 * math.pi * frequency, phase))
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
    episode["poke_steps"] = steps
    episode["pokes"] = np.count_nonzero(begin < episode["steps"])
    episode["poke_start"] = begin
    episode["poke_wrench"] = np.column_stack((size * np.cos(heading), size * np.sin(heading), size * lever))


@compiled
def shake_velocity(episode, axis, time):
    """Wrist velocity along one axis at a time; the shaking rises smoothly from rest."""
    amplitude, omega, phase = episode.shake[axis]
    speed = amplitude * omega * math.cos(omega * time + phase)
    if time < _SHAKE_RISE:
        speed *= 0.5 - 0.5 * math.cos(math.pi * time / _SHAKE_RISE)
    return speed


@compiled
def plan(episodes, worlds):
    """Before a control step: wrist acceleration and poke of the coming step."""
    for i in range(episodes.shape[0]):
        episode, world = episodes[i], worlds[i]
        time = (episode.step + 1) * episode.step_time
        x, z, pitch = (
            shake_velocity(episode, 0, time),
            shake_velocity(episode, 1, time),
            shake_velocity(episode, 2, time),
        )
        drive_wrist(episode, world, x, z, pitch)
        world.external[:] = 0.0
        for k in range(episode.pokes):
            if 0 <= episode.step - episode.poke_start[k] < episode.poke_steps:
                world.external[:] = episode.poke_wrench[k]


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
    name="Hold",
    key="hold",
    options=Options,
    terms=TERMS,
    columns=COLUMNS,
    start=start,
    plan=plan,
    judge=judge,
)
