"""How soon mu_c is right again after friction has jumped, while a controller acts on the estimate.

Time alone shows nothing: an object that is held does not show the new friction. So the time of slip
counts, of each finger whose estimate was right before the jump.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium as gym
import numpy as np
import pandas as pd
from tqdm import tqdm

import policies
from policies.research.leaderboard.closed_loop import present
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
        A row for each task, preset and factor: how many fingers count as `seen`, because mu_c was right
        before the jump and they slipped for at least 0.5 s after it, or until mu_c was right; those that were
        right again within 0.5 s of slip, and at all [%]; median and 90 % of the time of slip until then [s].
        A finger that never was right again counts with an infinite time.
    """
    rows = []
    cells = [
        (task, preset, factor) for task in tasks for preset in ("realistic", "lab") for factor in FACTORS
    ]
    for task, preset, factor in tqdm(cells, desc="jumps"):
        slipped, again = watched(
            task, episodes, seed, factor, estimator=estimator, sensors=preset, **arguments
        )
        counts = np.isfinite(again) | (slipped >= ENOUGH)
        times = again[counts]
        median, most = np.quantile(times, (0.5, 0.9), method="higher") if times.size else (np.nan, np.nan)
        rows.append(
            {
                "task": find(task).name,
                "sensors": preset,
                "factor": factor,
                "seen": times.size,
                "within 0.5 s": 100.0 * np.mean(times <= ENOUGH) if times.size else np.nan,
                "at all": 100.0 * np.mean(np.isfinite(times)) if times.size else np.nan,
                "median": median,
                "90 %": most,
            }
        )
    return pd.DataFrame(rows)


def watched(
    task: str, episodes: int, seed: int, factor: float, **arguments: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Plays one episode in each row of a batch.

    Args:
        task: Id of the environment.
        episodes: Rows.
        seed: Of the first row.
        factor: mu_c after over before.
        **arguments: Of the environments.

    Returns:
        For each finger (episodes, 2): time of slip after the jump, to the end [s]; the same until mu_c is
        right. The latter is infinite without that; it is NaN, and the former 0, if mu_c was not right before.
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
    first = present(env.simulation.plant.pads)["mu_c"]
    step_time = 1.0 / env.config.physics.control_rate
    was_right = np.zeros((episodes, 2), dtype=bool)
    slipped, again = np.zeros((episodes, 2)), np.full((episodes, 2), np.inf)
    for step in batch_steps(env, policy, observations):
        pads, estimates = env.simulation.plant.pads, env.simulation.estimator.estimates.reshape(-1, 2)
        truth = present(pads)["mu_c"]
        right = np.abs(estimates["mu_c"] / truth - 1.0) <= RIGHT
        jumped = np.abs(truth / first - 1.0) > RIGHT
        running = step.running[:, None]
        was_right = np.where(running & ~jumped, right, was_right)
        slipped += np.where(running & jumped & was_right & (pads["slip_speed"] > SLIPS), step_time, 0.0)
        again = np.where(running & jumped & right & np.isinf(again), slipped, again)
    env.close()
    return slipped, np.where(was_right, again, np.nan)
