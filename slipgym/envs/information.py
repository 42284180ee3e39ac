"""The info of a step: the truth beside what is estimated."""

from __future__ import annotations

from typing import Any

import numpy as np

from slipgym.envs.loop import SlipLoop
from slipgym.envs.observer import Observation


class Information:
    """Reads the infos of all environments out of a loop.

    Args:
        loop: What is reported.
    """

    def __init__(self, loop: SlipLoop) -> None:
        self._loop = loop
        plant, episode = loop.plant, loop.episode
        self._steps = episode["step"]
        self._views: dict[str, np.ndarray] = {
            "true": loop.true_friction,
            "estimated": loop.estimated[:, :3],
            "estimated_per_finger": loop.per_finger,
            "slip": plant.world["slip"],
            "slip_twist": plant.world["slip_twist"],
            "contact_wrench": plant.pads["wrench"],
            "grip_force": plant.fingers["force"],
            "reference": episode["reference"],
            "is_success": episode["success"],
            "dropped": episode["dropped"],
        }
        self._room: dict[str, Any] = {}

    def one(self, i: int) -> dict[str, Any]:
        """That of one environment, as `gymnasium.Env` gives it: the caller's own arrays, plain numbers."""
        loop = self._loop
        info: dict[str, Any] = {name: view[i].copy() for name, view in self._views.items()}
        for name in ("is_success", "dropped"):
            info[name] = info[name].item()
        info["reward_terms"] = dict(zip(loop.task.terms, loop.terms[i].tolist(), strict=True))
        info["time"] = self._steps.item(i) * loop.step_time
        return info

    def prepare(self) -> None:
        """Make room for the next infos of several environments: with thousands of them zeros take time."""
        if not self._room:
            loop = self._loop
            self._room = {name: np.zeros(view.shape, view.dtype) for name, view in self._views.items()}
            self._room["reward_terms"] = {name: np.zeros(loop.n) for name in loop.task.terms}
            self._room["time"] = np.zeros(loop.n)

    def of(self, mask: np.ndarray) -> dict[str, Any]:
        """Those of the environments of a mask (n,), as `gymnasium.vector.VectorEnv` gives them.

        Returns:
            Arrays (n, ...), the caller's own, zero where the mask is False; nothing at all without one that
            is True.
        """
        if not mask.any():
            return {}
        self.prepare()
        loop, rows = self._loop, slice(None) if mask.all() else np.flatnonzero(mask)
        infos, self._room = self._room, {}
        for name, view in self._views.items():
            infos[name][rows] = view[rows]
        for k, values in enumerate(infos["reward_terms"].values()):
            values[rows] = loop.terms[rows, k]
        infos["time"][rows] = self._steps[rows] * loop.step_time
        return infos


def masked(infos: dict[str, Any], mask: np.ndarray) -> dict[str, Any]:
    """Each info with a mask beside it that says which environments have it, as Gymnasium asks for."""
    beside: dict[str, Any] = {}
    for name, value in infos.items():
        beside[name] = masked(value, mask) if isinstance(value, dict) else value
        beside[f"_{name}"] = mask.copy()
    return beside


def final(observations: Observation, infos: dict[str, Any], over: np.ndarray) -> dict[str, Any]:
    """Infos that hold the last observations and infos of episodes that are over.

    Args:
        observations: Of all environments.
        infos: Of all environments, without masks.
        over: Which episodes are over, (n,).
    """
    if not over.any():
        return {}
    last = np.full(len(over), None, dtype=object)
    for i in np.flatnonzero(over).tolist():
        if isinstance(observations, dict):
            last[i] = {group: values[i] for group, values in observations.items()}
        else:
            last[i] = observations[i]
    return masked({"final_obs": last, "final_info": infos}, over)
