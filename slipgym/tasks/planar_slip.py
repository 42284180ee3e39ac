"""PlanarSlip: the object is moved in the grip to a given pose (x, y, theta) by gravity, wrist and grip."""

from __future__ import annotations

import math

import numpy as np
from pydantic import Field

from slipgym.compiled import compiled
from slipgym.config import Config
from slipgym.config.base import Positive
from slipgym.tasks.episode import detect_drop, drive_wrist, effort, roughness
from slipgym.tasks.options import EpisodeOptions
from slipgym.tasks.task import Column, Task

TERMS = ("position", "angle", "distance", "effort", "smoothness", "wrist", "drop")
COLUMNS = (
    Column("target_x", -1.0, 1.0, "m", "slip displacement to reach, along the pads' x axis"),
    Column("target_y", -1.0, 1.0, "m", "the same along the pads' y axis"),
    Column("target_theta", -10.0, 10.0, "rad", "the same about the grip axis"),
    Column("time_left", 0.0, 1000.0, "s", "time until the episode ends"),
)


class Options(EpisodeOptions):
    """What `reset(options=...)` can fix."""

    slide: Positive | None = Field(default=None, le=0.1, description="Length of the target's slide [m]")
    heading: float | None = Field(
        default=None, ge=-1.6, le=1.6, description="Pitch of the wrist during that slide [rad]"
    )
    turn: float | None = Field(default=None, ge=-1.6, le=1.6, description="Angle of the target's turn [rad]")
    duration: Positive | None = Field(default=None, le=120.0, description="Length of the episode [s]")
    tolerance: Positive | None = Field(
        default=None, description="Largest final error in (x, y) for success [m]"
    )
    angle_tolerance: Positive | None = Field(
        default=None, description="Largest final error in theta for success [rad]"
    )


def start(config: Config, options: EpisodeOptions, rng: np.random.Generator, episode: np.void) -> None:
    """Fill one EPISODE row; the target is the end of a plan that is drawn: slide, then turn."""
    task = config.tasks.planar_slip
    # drawn always, so that options do not shift later draws
    drawn = {
        "slide": rng.uniform(*task.slide),
        "heading": rng.uniform(-task.heading, task.heading),
        "turn": rng.uniform(*task.turn) * (-1, 1)[rng.integers(2)],
    }
    plan = {name: getattr(options, name) for name in drawn}
    slide, heading, turn = (drawn[name] if plan[name] is None else plan[name] for name in drawn)
    episode["target"] = hang(slide, heading, turn)
    for field in ("tolerance", "angle_tolerance"):
        episode[field] = options.choose(field, task)
    episode["rest_speed"] = task.rest_speed
    episode["steps"] = max(1, round(options.choose("duration", task) / episode["step_time"]))


def hang(slide: float, heading: float, turn: float) -> tuple[float, float, float]:
    """Slip displacement after a slide along gravity and a turn about the pad centre.

    Args:
        slide: Length of the slide [m].
        heading: Pitch of the wrist during it [rad].
        turn: Angle by which the object then turns in the grip [rad].

    Returns:
        (x, y, theta) [m, m, rad]; the slide by `turn` turned about the pad centre.
    """
    down = heading - turn
    return -slide * math.sin(down), -slide * math.cos(down), turn


@compiled
def plan(episodes, worlds):
    """Before a control step: the wrist moves as the agent commands."""
    for i in range(episodes.shape[0]):
        drive_wrist(episodes[i], worlds[i], 0.0, 0.0, 0.0)


@compiled
def judge(episodes, worlds, fingers, columns):
    """After a control step: distance to the target, reward terms, outcome, observation.

    Args:
        episodes: EPISODE (n,).
        worlds: WORLD (n,).
        fingers: FINGER (n, 2).
        columns: Output (n, 4), see `COLUMNS`.
    """
    for i in range(episodes.shape[0]):
        episode, world = episodes[i], worlds[i]
        target, slip, twist, wrist = episode.target, world.slip, world.slip_twist, episode.wrist_command
        for k in range(3):
            episode.reference[k] = columns[i, k] = target[k]
        columns[i, 3] = (episode.steps - episode.step) * episode.step_time
        away = math.hypot(slip[0] - target[0], slip[1] - target[1]) / episode.tolerance
        askew = abs(slip[2] - target[2]) / episode.angle_tolerance
        speed = math.hypot(math.hypot(twist[0], twist[1]), episode.pad_radius * twist[2])
        episode.dropped = detect_drop(episode, world, fingers[i])
        episode.success = (
            episode.step >= episode.steps
            and not episode.dropped
            and away <= 1.0
            and askew <= 1.0
            and speed <= episode.rest_speed
        )
        moved = math.hypot(wrist[0], wrist[1]) / episode.wrist_speed_max
        pitched = wrist[2] / episode.wrist_pitch_rate_max
        terms = (
            math.exp(-(away**2)),
            math.exp(-(askew**2)),
            -min(0.5 * (away + askew), 10.0),
            -effort(episode, fingers[i]),
            -roughness(episode),
            -(moved**2 + pitched**2),
            -1.0 if episode.dropped else 0.0,
        )
        for k in range(7):
            episode.terms[k] = episode.scales[k] * terms[k]


TASK = Task(
    name="PlanarSlip",
    key="planar_slip",
    options=Options,
    terms=TERMS,
    columns=COLUMNS,
    start=start,
    plan=plan,
    judge=judge,
    action_mode="grip_force_pitch",
)
