"""Measures how soon mu_c is right again after friction has jumped, while a controller acts on the estimate.

Time alone shows nothing: an object that is held does not show the new friction. So the time of slip counts,
of each finger whose estimate was right before the jump. An estimate that passes the truth on its way to
another error was right for a moment. So it also counts whether it is right after 0.5 s of slip. The reference
for what the sensors and motions allow are the same episodes without a jump.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
import pandas as pd
from numpy.typing import NDArray
from tqdm import tqdm

import policies
from lab.leaderboard.closed_loop import present
from policies.stepping import batch_steps
from slipgym.tasks import find

FACTORS = 0.7, 1.35
"""mu_c after over before."""
TIME = 1.0, 4.0
"""Between these times friction jumps [s]."""
RIGHT = 0.05
"""Relative error up to which mu_c is right."""
SLIPS = 1e-3
"""Scaled slip speed of a slip [m/s]."""
ENOUGH = 0.5
"""Time of slip within which mu_c should be right again [s]."""
TASKS = "slipgym/LinearSlip-v0", "slipgym/PlanarSlip-v0"


class Course(NamedTuple):
    """What happened in a batch of episodes: arrays (steps, episodes, 2), one number a finger."""

    error: NDArray[np.float64]
    """Relative error of mu_c."""
    mu_c: NDArray[np.float64]
    """The true one."""
    slips: NDArray[np.bool_]
    running: NDArray[np.bool_]
    step_time: float
    """Time of a step [s]."""


def jumps(
    episodes: int, seed: int = 0, tasks: Sequence[str] = TASKS, estimator: Any = "adaptive", **arguments: Any
) -> pd.DataFrame:
    """Plays episodes in which friction jumps, with the sensors "realistic" and "lab".

    Args:
        episodes: Of each combination.
        seed: Of the first episode.
        tasks: Ids of environments.
        estimator: As the environments take it.
        **arguments: Of the environments.

    Returns:
        A row for each task, preset and factor, see `summary`.
    """
    rows = []
    for task in tasks:
        for preset in ("realistic", "lab"):
            chosen = {"estimator": estimator, "sensors": preset, **arguments}
            without = watched(task, episodes, seed, 1.0, **chosen)
            for factor in tqdm(FACTORS, desc=f"{find(task).name}, {preset}"):
                found = summary(watched(task, episodes, seed, factor, **chosen), without)
                rows.append({"task": find(task).name, "sensors": preset, "factor": factor, **found})
    return pd.DataFrame(rows)


def watched(task: str, episodes: int, seed: int, factor: float, **arguments: Any) -> Course:
    """Plays one episode in each row of a batch.

    Args:
        task: Id of the environment.
        episodes: Rows.
        seed: Of the first row.
        factor: mu_c after over before; the time of the jump does not depend on it.
        **arguments: Of the environments.
    """
    when = {"uniform": list(TIME)}
    jump = {"kind": "friction_jump", "probability": 1.0, "time": when, "factor": {"choices": [factor]}}
    policy = policies.make(find(task).key)
    env: Any = gym.make_vec(
        task,
        num_envs=episodes,
        **policies.modes(policy),
        randomization={"disturbances": [jump]},
        **arguments,
    ).unwrapped
    observations, _ = env.reset(seed=seed)
    steps: list[tuple[np.ndarray, ...]] = []
    for step in batch_steps(env, policy, observations):
        pads, estimates = env.simulation.plant.pads, env.simulation.estimator.estimates.reshape(-1, 2)
        truth = present(pads)["mu_c"]
        running = np.broadcast_to(step.running[:, None], truth.shape)
        steps.append((estimates["mu_c"] / truth - 1.0, truth, pads["slip_speed"] > SLIPS, running))
    env.close()
    errors, truths, slips, alive = (np.array(values) for values in zip(*steps, strict=True))
    return Course(errors, truths, slips, alive, 1.0 / env.config.physics.control_rate)


def summary(course: Course, without: Course) -> dict[str, float]:
    """How soon fingers are right again.

    Args:
        course: Episodes with jumps.
        without: The same episodes without.

    Returns:
        How many fingers are `seen`, because mu_c was right before the jump and they slipped for at least
        0.5 s after it or until mu_c was right; median of the time of slip until it was right again [s],
        infinite if it never was; those that were within 0.5 s of slip [%]; those that are right at 0.5 s of
        slip, or at the end of an episode with less [%]; the same without a jump [%].
    """
    after = np.abs(course.mu_c / course.mu_c[0] - 1.0) > RIGHT
    jumped = after.any(axis=0)
    start = np.where(jumped, after.argmax(axis=0), 1)
    before = np.take_along_axis(course.error, np.maximum(start - 1, 0)[None], 0)[0]
    slipped = _slipped(course, start)
    right = course.running & after & (np.abs(course.error) <= RIGHT)
    again = np.where(right, slipped, np.inf).min(axis=0)
    seen = jumped & (np.abs(before) <= RIGHT) & (np.isfinite(again) | (slipped[-1] >= ENOUGH))
    times = again[seen]
    found, usual = (np.abs(_then(each, start)[seen]) for each in (course, without))
    return {
        "seen": int(seen.sum()),
        "first right": float(np.quantile(times, 0.5, method="higher")) if times.size else float("nan"),
        "within 0.5 s": _percent(times <= ENOUGH),
        "right at 0.5 s": _percent(found <= RIGHT),
        "without jump": _percent(usual <= RIGHT),
    }


def _percent(true: NDArray[np.bool_]) -> float:
    return 100.0 * float(true.mean()) if true.size else float("nan")


def _slipped(course: Course, start: NDArray[np.int64]) -> NDArray[np.float64]:
    """Time of slip since a step of each finger [s], (steps, episodes, 2)."""
    counts = np.arange(len(course.slips))[:, None, None] >= start
    steps = np.cumsum(course.slips & course.running & counts, axis=0)
    return np.asarray(steps * course.step_time, dtype=np.float64)


def _then(course: Course, start: NDArray[np.int64]) -> NDArray[np.float64]:
    """Error after 0.5 s of slip since a step of each finger, or at the end."""
    enough = (_slipped(course, start) >= ENOUGH - 0.5 * course.step_time) & course.running
    last = course.running.sum(axis=0) - 1
    at = np.where(enough.any(axis=0), enough.argmax(axis=0), last)
    return np.asarray(np.take_along_axis(course.error, at[None], 0)[0])
