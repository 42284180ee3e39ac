"""A hanging object round which the gripper turns: the paper's planar motion, as a task for `Simulation`."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np

from slipgym.config.base import Positive
from slipgym.config.task import MassRange, TaskConfig, setting
from slipgym.tasks import Task
from slipgym.tasks.episode import schedule, trapezoid
from slipgym.tasks.options import EpisodeOptions


class Settings(TaskConfig):
    """The wrist pitches by an angle in a given time."""

    turn: Annotated[float, setting("Angle that the wrist pitches by", "rad", reset=True)] = math.radians(60.0)
    duration: Annotated[Positive, setting("Time for the turn", "s", reset=True)] = 5.0
    settle: Annotated[Positive, setting("Time before the turn", "s")] = 0.5
    hold: Annotated[Positive, setting("Time after the turn", "s")] = 0.5
    mass_range: MassRange = (0.1, 0.4)


def start(settings: Settings, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; nothing here is drawn at random."""
    episode["goal"] = settings.turn
    schedule(settings, episode)


def wrist_velocity(episode, world):
    """The wrist's pitch follows the trapezoid, its place stays."""
    time = (episode.step + 1) * episode.step_time - episode.settle
    return 0.0, 0.0, trapezoid(time, episode.goal, episode.duration)[1]


def success(episode, world):
    """Nothing is evaluated here."""
    return False


TASK = Task(
    id="policies/Hanging-v0",
    settings=Settings,
    start=start,
    wrist_velocity=wrist_velocity,
    success=success,
    terms=(),
    columns=(),
)
