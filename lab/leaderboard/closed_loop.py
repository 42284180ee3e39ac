"""Estimators in the loop: the task's controller acts on the estimate, which the episode then judges.

Every episode is one row of a batch. Friction, sensors and pads are sampled; the truth is that of each finger
at its present load and age.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
import pandas as pd
from tqdm import tqdm

import policies
from policies.stepping import batch_steps
from slipgym.registration import TASK_MODULES
from slipgym.tasks import find

VALUES = "mu_s", "mu_c", "r"
SURE = 0.5
"""Confidence from which an estimate at an episode's end counts."""
FURTHER = {"linear_slip": ("linear_slip_continuous", "linear_slip_leaps")}
"""Task -> controllers that are played beside its own."""


def closed_loop(
    estimators: Sequence[str] | Mapping[str, Any],
    episodes: int = 200,
    sensors: Sequence[str] | Mapping[str, Mapping[str, Any]] = ("realistic", "lab"),
    seed: int = 0,
    tasks: Sequence[str] = tuple(TASK_MODULES),
    **arguments: Any,
) -> pd.DataFrame:
    """Plays episodes of every task with every estimator and sensor preset.

    Args:
        estimators: Names, or label -> the environments' argument `estimator`.
        episodes: Of each combination; the same initial conditions in all.
        sensors: Sensor presets, or label -> arguments of the environments.
        seed: Of the first episode.
        tasks: Ids of environments.
        **arguments: Of the environments, for example `randomization="lab"`.

    Returns:
        A row for each combination, those of `FURTHER` among them: see `played`.
    """
    rows = []
    choices = estimators if isinstance(estimators, Mapping) else {name: name for name in estimators}
    presets = sensors if isinstance(sensors, Mapping) else {name: {"sensors": name} for name in sensors}
    played_by = [(task, key) for task in tasks for key in _controllers(task)]
    cells = [(*pair, name, preset) for pair in played_by for name in choices for preset in presets]
    for task, key, name, preset in tqdm(cells, desc="closed loop"):
        own = {"estimator": choices[name], **presets[preset], **arguments}
        found = played(task, episodes, seed, key, **own)
        label = find(task).name if key == find(task).key else key
        rows.append({"task": label, "estimator": name, "sensors": preset, **found})
    return pd.DataFrame(rows)


def _controllers(task: str) -> tuple[str, ...]:
    return find(task).key, *FURTHER.get(find(task).key, ())


def played(
    task: str, episodes: int, seed: int, controller: str | None = None, **arguments: Any
) -> dict[str, float]:
    """Plays one episode in each row of a batch, with a controller.

    Args:
        task: Id of the environment.
        episodes: Rows.
        seed: Of the first row.
        controller: As `policies.make` takes it; None: the task's own.
        **arguments: Of the environments.

    Returns:
        `solved` and `dropped` [%]; for each of mu_s, mu_c, r the share of ends, of both fingers, with a
        confidence above SURE [%], the median of the error's size there [%], the same of the ends with any
        confidence (`seen`, `seen error`), and the share of instants, from the first update on, within one and
        within two stated deviations [%], and the `episodes` with such instants; `reversed`: instants with a
        published mu_c above mu_s [%].
    """
    policy = policies.make(controller or find(task).key)
    policies.check_estimates(controller or find(task).key, policy, arguments)
    env: Any = gym.make_vec(task, num_envs=episodes, **policies.modes(policy), **arguments).unwrapped
    observations, _ = env.reset(seed=seed)
    tally = _Tally(episodes)
    for step in batch_steps(env, policy, observations):
        tally.add(env.simulation, step.running)
        if step.ended.any():
            tally.end(env.simulation, step.ended, step.infos)
    env.close()
    return tally.result()


class _Tally:
    """Counts instants and ends of episodes."""

    def __init__(self, episodes: int) -> None:
        self._instants = {name: np.zeros(3) for name in VALUES}  # seen, within one, within two
        self._seen = {name: np.zeros(episodes, dtype=bool) for name in VALUES}
        self._errors: dict[str, list[float]] = {name: [] for name in VALUES}  # of ends with confidence > SURE
        self._seen_errors: dict[str, list[float]] = {name: [] for name in VALUES}  # > 0
        self._all, self._reversed, self._solved, self._dropped, self._episodes = 0, 0, 0, 0, episodes

    def add(self, simulation: Any, alive: np.ndarray) -> None:
        """The instant after a control step."""
        estimates = simulation.estimator.estimates.reshape(-1, 2)[alive]
        truth = {name: value[alive] for name, value in present(simulation.plant.pads).items()}
        self._all += estimates.size
        self._reversed += np.count_nonzero(estimates["mu_c"] > estimates["mu_s"])
        for name in VALUES:
            known = estimates[f"confidence_{name}"] > 0.0
            off = np.abs(estimates[name] - truth[name])[known] / estimates[f"sd_{name}"][known]
            self._seen[name][alive] |= known.any(axis=1)
            self._instants[name] += off.size, np.count_nonzero(off <= 1.0), np.count_nonzero(off <= 2.0)

    def end(self, simulation: Any, over: np.ndarray, infos: Mapping[str, Any]) -> None:
        """The ends of episodes."""
        estimates = simulation.estimator.estimates.reshape(-1, 2)[over]
        for name, value in present(simulation.plant.pads).items():
            error = 100.0 * np.abs(estimates[name] / value[over] - 1.0)
            confidence = estimates[f"confidence_{name}"]
            self._errors[name] += error[confidence > SURE].tolist()
            self._seen_errors[name] += error[confidence > 0.0].tolist()
        self._solved += np.count_nonzero(infos["is_success"][over])
        self._dropped += np.count_nonzero(infos["dropped"][over])

    def result(self) -> dict[str, float]:
        """See `played`."""
        row = {
            "solved": 100.0 * self._solved / self._episodes,
            "dropped": 100.0 * self._dropped / self._episodes,
        }
        for name in VALUES:
            seen, one, two = self._instants[name]
            for share, size, errors in (
                ("sure", "error", self._errors[name]),
                ("seen", "seen error", self._seen_errors[name]),
            ):
                row[f"{name} {share}"] = 50.0 * len(errors) / self._episodes
                row[f"{name} {size}"] = float(np.median(errors)) if errors else np.nan
            row[f"{name} in 1 sd"] = 100.0 * one / seen if seen else np.nan
            row[f"{name} in 2 sd"] = 100.0 * two / seen if seen else np.nan
            row[f"{name} episodes"] = int(np.count_nonzero(self._seen[name]))
        return {**row, "reversed": 100.0 * self._reversed / self._all}


def pooled(table: pd.DataFrame) -> pd.DataFrame:
    """Shares within the stated deviations over all tasks, each with its own controller.

    Args:
        table: Of `closed_loop`.

    Returns:
        A row for each estimator, sensor preset and quantity: the mean of the shares of the tasks, weighted by
        their `episodes`, and its binomial standard error, as if an episode were one instant [%].
    """
    further = [key for keys in FURTHER.values() for key in keys]
    own = [row for row in table.to_dict("records") if row["task"] not in further]
    rows = []
    for pair in dict.fromkeys((row["estimator"], row["sensors"]) for row in own):
        group = [row for row in own if (row["estimator"], row["sensors"]) == pair]
        for value in VALUES:
            seen = [row for row in group if row[f"{value} episodes"] > 0]
            n = np.array([row[f"{value} episodes"] for row in seen], dtype=float)
            found = {"estimator": pair[0], "sensors": pair[1], "quantity": value, "episodes": int(n.sum())}
            for key in ("in 1 sd", "in 2 sd"):
                share = np.array([row[f"{value} {key}"] for row in seen], dtype=float) / 100.0
                square = float(np.sum(n * share * (1.0 - share)))
                found[key] = 100.0 * float(n @ share) / n.sum() if seen else np.nan
                found[f"± {key}"] = 100.0 * square**0.5 / n.sum() if seen else np.nan
            rows.append(found)
    return pd.DataFrame(rows)


def present(pads: np.ndarray) -> dict[str, np.ndarray]:
    """mu_s, mu_c [-] and r [m] of pads at their present load and age, each (n, 2)."""
    mu_c = pads["friction_scale"] * pads["mu_c"]
    growth = pads["friction_scale"] * pads["static_gain"] * (pads["mu_s"] - pads["mu_c"])
    return {"mu_s": mu_c + growth, "mu_c": mu_c, "r": pads["radius"].copy()}
