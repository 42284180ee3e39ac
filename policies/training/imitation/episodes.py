"""Episodes of an imitation: observations of the network, and what the controller would do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np

import policies
from policies.controllers import table as controllers
from policies.controllers.rate import at_rate
from policies.learned.policy import Network
from policies.training.imitation.config import Imitation
from slipgym.envs.actions import LOGARITHMIC
from slipgym.envs.load_part import LOAD
from slipgym.envs.observation import FRICTION_COLUMNS
from slipgym.tasks import find

_FRICTION = [column.name for column in FRICTION_COLUMNS]
_LOAD = {reading.name for reading in LOAD}
KNOWN = 0.05
"""Confidence of an estimate from which the teacher "revealed" is given the truth in its place [-]."""


@dataclass(frozen=True)
class Demonstrations:
    """n episodes of at most T steps; those that ended early are filled with zeros.

    Attributes:
        observations: What the network observes, (T, n, m) float32.
        actions: What the controller would do in its place, (T, n, k) float32.
        lengths: Steps of each episode, (n,).
        solved: Whether each was a success, (n,) bool.
    """

    observations: np.ndarray
    actions: np.ndarray
    lengths: np.ndarray
    solved: np.ndarray


def arguments(config: Imitation) -> dict[str, Any]:
    """Keyword arguments of the environments, with the action mode of the controller or its logarithmic one.

    Raises:
        ValueError: The controller has no logarithmic mode, or needs another mode than the one given.
    """
    given = config.environment.model_dump(mode="json")
    modes = policies.modes(policies.make(find(config.task).key))
    if given["action_mode"] is not None:
        wanted = LOGARITHMIC + modes["action_mode"]
        if given["action_mode"] != wanted:
            needs = f"the controller of {config.task} needs {wanted!r}, or null"
            raise ValueError(f"environment.action_mode = {given['action_mode']!r}: {needs}")
        modes["action_mode"] = wanted
    mode = modes.get("observation_mode", given["observation_mode"])
    shown = "observation_mode" in config.environment.model_fields_set and given["friction_source"] != "none"
    if shown and given["observation_mode"] != mode:
        needs = f"the controller of {config.task} needs {mode!r}"
        raise ValueError(f"environment.observation_mode = {given['observation_mode']!r}: {needs}")
    return {**given, **modes}


class Scene:
    """The environments (`rows` of them) of an imitation, and the controller that is imitated."""

    def __init__(self, config: Imitation, rows: int) -> None:
        task, given = find(config.task), arguments(config)
        self._teacher, source = config.teacher, given["friction_source"]
        if config.teacher != "truth":
            given["friction_source"] = "estimated"
        self.envs: Any = gym.make_vec(f"slipgym:{task.id}", rows, "vector_entry_point", **given).unwrapped
        at = at_rate(self.envs.metadata["render_fps"], given["config"])
        self.controller = controllers.make(task.key, {"config": at})
        names = [column.name for column in self.envs.columns]
        self._bare = names.index(_FRICTION[0]) if _FRICTION[0] in names else len(names)
        blind = [k for k, name in enumerate(names) if k < self._bare or name in _LOAD]
        self._kept = blind if source == "none" else list(range(len(names)))
        (force,) = self.envs.action_columns[:1]
        self._ends = np.exp([force.low, force.high]) if given["action_mode"].startswith(LOGARITHMIC) else None

    def seen(self, observations: np.ndarray) -> np.ndarray:
        """The network's part of observations (n, m)."""
        return observations[:, self._kept]

    def acted(self, actions: np.ndarray) -> np.ndarray:
        """Actions (n, k) of the controller as the environments take them, on the scale of their grip."""
        if self._ends is None:
            return actions
        low, high = self._ends
        force, found = low + 0.5 * (np.clip(actions[:, 0], -1.0, 1.0) + 1.0) * (high - low), actions.copy()
        found[:, 0] = 2.0 * np.log(force / low) / np.log(high / low) - 1.0
        return found

    def taught(self, observations: np.ndarray, true: np.ndarray) -> np.ndarray:
        """The controller's observations, from those given (n, m) and the true mu_s, mu_c, r, (n, 3)."""
        if self._teacher == "estimate":
            return observations
        confidence = np.ones_like(true)
        if self._teacher == "revealed":
            values, stated = np.split(observations[:, self._bare : self._bare + len(_FRICTION)], 2, axis=1)
            known = stated >= KNOWN
            true, confidence = np.where(known, true, values), np.where(known, 1.0, stated)
        return np.column_stack((observations[:, : self._bare], true, confidence)).astype(np.float32)

    def close(self) -> None:
        """Close the environments."""
        self.envs.close()


def demonstrate(scene: Scene, network: Network | None, acts: np.ndarray, seed: int) -> Demonstrations:
    """Plays an episode in each environment; the controller says at each step what it would do.

    The network, if there is one, acts in the rows `acts`, (n,) bool; the seed is the first environment's.
    """
    envs, n = scene.envs, scene.envs.num_envs
    observations, infos = envs.reset(seed=seed)
    memory: Any = None
    if network is not None and network.memory_shape is not None:
        memory = (np.zeros((n, *network.memory_shape), np.float32),) * 2  # copied before it is written to
    state, running, solved = None, np.ones(n, bool), np.zeros(n, bool)
    seen, wanted, lengths = [], [], np.zeros(n, np.int64)
    while running.any():
        asked, state = scene.controller.predict(scene.taught(observations, infos["true"]), state)
        actions = labels = scene.acted(asked)
        observed = scene.seen(observations)
        if network is not None:
            given, memory = network.forward(observed, memory)
            actions = np.where(acts[:, None], given, labels)
        seen.append(np.where(running[:, None], observed, np.float32(0.0)))
        wanted.append(np.where(running[:, None], labels, np.float32(0.0)))
        lengths[running] += 1
        observations, _, terminated, truncated, infos = envs.step(actions)
        ended = running & (terminated | truncated)
        solved[ended] = infos["is_success"][ended]
        running = running & ~ended
    return Demonstrations(np.array(seen, np.float32), np.array(wanted, np.float32), lengths, solved)
