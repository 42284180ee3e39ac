"""Records episodes as the estimator of each finger sees them, with the true friction of that finger."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np

import policies
from lab.leaderboard.closed_loop import VALUES, present
from lab.learned_estimator.recorder import NAME, ROOM
from slipgym.sensors.unloaded import READINGS
from slipgym.tasks import find

CHANGE = 0.05
"""Chance in a control step that a random part of the actions changes [-]."""


@dataclass(frozen=True)
class Recording:
    """One finger in one episode."""

    readings: np.ndarray
    """(f_x, f_y, f_n, tau, v_x, v_y, omega) as measured, (n, 7) [N, N, N, N m, m/s, m/s, rad/s]; the first
    `READINGS` are those of the open gripper."""
    truth: np.ndarray
    """True mu_s, mu_c [-] and r [m] of the finger at its present load and age, (n, 3); first NaN."""


def record(
    task: str,
    rows: int,
    steps: int,
    seed: int,
    disturbed: float = 0.0,
    **arguments: Any,
) -> Iterator[Recording]:
    """Plays a batch of episodes with the task's controller.

    An episode that ends is followed by another one in its row, until all steps are made.

    Args:
        task: A task, as `slipgym.tasks.find` takes it.
        rows: Environments.
        steps: Control steps.
        seed: Of the first environment, >= 0; and of the disturbed actions.
        disturbed: Fraction of the rows whose actions are disturbed: in half of them a random piecewise
            constant part is added, in the others it replaces the controller's [-].
        **arguments: Of the environments, such as `sensors`.

    Yields:
        A recording for each finger and episode; those shorter than 0.2 s are left out.
    """
    found = find(task)
    policy = policies.make(found.key)
    modes = {**policies.modes(policy), **arguments}
    env: Any = gym.make_vec(found.id, num_envs=rows, estimator=NAME, **modes).unwrapped
    rng = np.random.default_rng([seed, rows, steps])
    kind = np.where(rng.random(rows) < disturbed, rng.integers(1, 3, rows), 0)
    noise = _Noise(rng, (rows, *env.single_action_space.shape))
    truth = np.full((rows, 2, ROOM, 3), np.nan, np.float32)
    states = env.simulation.estimator.states.reshape(rows, 2)
    all_rows = np.arange(rows)[:, None], np.arange(2)[None]
    observations, _ = env.reset(seed=seed)
    begun, memory = np.ones(rows, bool), None
    try:
        for step in range(steps):
            actions, memory = policy.predict(observations, memory, begun)
            observations, _, terminated, truncated, _ = env.step(noise.mixed(actions, kind))
            at = np.minimum(states["samples"] - 1, ROOM - 1)
            now = present(env.simulation.plant.pads)
            truth[(*all_rows, at)] = np.stack([now[name] for name in VALUES], axis=-1)
            begun = terminated | truncated
            for i in np.flatnonzero(begun | (step == steps - 1)).tolist():
                yield from _recordings(states[i], truth[i])
                truth[i] = np.nan
    finally:
        env.close()


def _recordings(states: np.ndarray, truth: np.ndarray) -> Iterator[Recording]:
    for state, values in zip(states, truth, strict=True):
        n = min(int(state["samples"]), ROOM)
        if n > READINGS + 24:
            yield Recording(state["readings"][:n].copy(), values[:n].copy())


class _Noise:
    """Random piecewise constant actions."""

    def __init__(self, rng: np.random.Generator, shape: tuple[int, ...]) -> None:
        self._rng = rng
        self._level = rng.uniform(-1.0, 1.0, shape)
        self._size = rng.uniform(0.05, 0.5, (shape[0], 1))

    def mixed(self, actions: np.ndarray, kind: np.ndarray) -> np.ndarray:
        """Actions (n, m) where `kind` is 0, disturbed ones where it is 1, random ones where it is 2."""
        drawn = self._rng.uniform(-1.0, 1.0, self._level.shape)
        changes = self._rng.random((len(actions), 1)) < CHANGE
        self._level = np.where(changes, drawn, self._level)
        plain, other = kind[:, None] == 0, kind[:, None] == 2
        disturbed = np.where(other, self._level, actions + self._size * self._level)
        return np.where(plain, actions, np.clip(disturbed, -1.0, 1.0)).astype(actions.dtype)
