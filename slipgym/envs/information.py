"""The info of a step: the truth beside what is estimated."""

from __future__ import annotations

from typing import Any

import numpy as np

from slipgym.envs.loop import SlipLoop
from slipgym.envs.observer import Observation
from slipgym.envs.rooms import Rooms
from slipgym.envs.told import FLAGS, PARTS, SHAPES, WIDTH, field

_VECTORS = tuple(name for name, shape in SHAPES.items() if len(shape) == 1)
_MATRICES = tuple(name for name, shape in SHAPES.items() if len(shape) == 2)
_NUMBERS = slice(PARTS["time"].start, PARTS["dropped"].stop)


class Information:
    """Reads the infos of all environments out of a loop.

    Args:
        loop: What is reported.
    """

    def __init__(self, loop: SlipLoop) -> None:
        self._loop = loop
        self._rooms = Rooms(loop.n, WIDTH + len(loop.task.terms))

    def one(self, i: int) -> dict[str, Any]:
        """That of one environment, as `gymnasium.Env` gives it: the caller's own arrays, plain numbers."""
        loop = self._loop
        row = loop.told[i].copy()
        info: dict[str, Any] = {name: row[PARTS[name]] for name in _VECTORS}
        for name in _MATRICES:
            info[name] = row[PARTS[name]].reshape(SHAPES[name])
        time, success, dropped = row[_NUMBERS].tolist()
        info["is_success"], info["dropped"] = success != 0.0, dropped != 0.0
        info["reward_terms"] = dict(zip(loop.task.terms, loop.terms[i].tolist(), strict=True))
        info["time"] = time
        return info

    def of(self, mask: np.ndarray) -> dict[str, Any]:
        """Those of the environments of a mask (n,), as `gymnasium.vector.VectorEnv` gives them.

        Returns:
            Arrays (n, ...), the caller's own, zero where the mask is False; nothing at all without one that
            is True.
        """
        if not mask.any():
            return {}
        told, terms, names = self._loop.told, self._loop.terms, self._loop.task.terms
        if mask.all():
            infos: dict[str, Any] = {name: field(told, name) for name in SHAPES}
            return {**infos, "reward_terms": {name: terms[:, k].copy() for k, name in enumerate(names)}}
        rows, n = np.flatnonzero(mask), len(mask)
        told = told[rows]
        room = self._rooms.fill(rows, np.hstack([told, terms[rows]]))
        infos = {name: room[:, PARTS[name]].reshape(n, *shape) for name, shape in SHAPES.items()}
        for name in FLAGS:
            infos[name] = np.zeros(n, dtype=bool)
            infos[name][rows] = field(told, name)
        return {**infos, "reward_terms": {name: room[:, WIDTH + k] for k, name in enumerate(names)}}


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
