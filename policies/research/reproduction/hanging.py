"""A hanging object round which the gripper turns: the paper's planar motion, as a task for `Simulation`."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from pydantic import Field

from slipgym._numba.compiled import compiled
from slipgym.config import Config
from slipgym.config.base import Positive
from slipgym.tasks import TASKS
from slipgym.tasks.episode import detect_drop, trapezoid
from slipgym.tasks.options import EpisodeOptions

SETTLE, REST = 0.5, 0.5  # [s] before and after the turn


class Options(EpisodeOptions):
    """What a trial fixes."""

    turn: float = Field(default=math.radians(60.0), description="Angle that the wrist pitches by [rad]")
    duration: Positive = Field(default=5.0, description="Time for the turn [s]")


def start(config: Config, options: Options, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; nothing here is drawn at random."""
    episode["goal"], episode["duration"], episode["settle"] = options.turn, options.duration, SETTLE
    episode["steps"] = round((SETTLE + options.duration + REST) / episode["step_time"])


@compiled
def plan(episodes, worlds):
    """Before a control step: the wrist's pitch follows the trapezoid, its place stays."""
    for i in range(episodes.shape[0]):
        episode, world = episodes[i], worlds[i]
        time = (episode.step + 1) * episode.step_time - episode.settle
        _, rate, _ = trapezoid(time, episode.goal, episode.duration)
        world.wrist_acceleration[2] = (rate - world.wrist_velocity[2]) / episode.step_time


@compiled
def judge(episodes, worlds, fingers, columns):
    """After a control step: whether the object was lost. No rewards, no observation."""
    for i in range(episodes.shape[0]):
        episodes[i].dropped = detect_drop(episodes[i], worlds[i], fingers[i])


TASK = replace(
    TASKS["Hold"],  # whose group of the configuration holds what the options leave open
    id="policies/Hanging-v0",
    options=Options,
    reward=(),
    columns=(),
    start=start,
    plan=plan,
    judge=judge,
)
