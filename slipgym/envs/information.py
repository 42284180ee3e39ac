"""The info of a step: the truth beside what is estimated."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from slipgym.envs.observer import Observation
from slipgym.envs.rooms import Rooms
from slipgym.envs.simulation import Simulation
from slipgym.envs.told import PARTS, SHAPES

_VECTORS = tuple(name for name, shape in SHAPES.items() if len(shape) == 1)
_MATRICES = tuple(name for name, shape in SHAPES.items() if len(shape) == 2)


class Information:
    """Reads the infos of all environments out of a simulation.

    Args:
        simulation: What is reported.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation, self._terms = simulation, simulation.task.term_names
        self._rooms = Rooms(simulation.n, self._terms)

    def one(self, i: int) -> dict[str, Any]:
        """That of one environment, as `gymnasium.Env` gives it: the caller's own arrays, plain numbers."""
        numbers, flags, terms = self._simulation.told
        row = numbers[i].copy()
        info: dict[str, Any] = {name: row[PARTS[name]] for name in _VECTORS}
        for name in _MATRICES:
            info[name] = row[PARTS[name]].reshape(SHAPES[name])
        info["time"] = row.item(PARTS["time"].start)
        info["is_success"], info["dropped"] = flags[i].tolist()
        info["reward_terms"] = dict(zip(self._terms, terms[i].tolist(), strict=True))
        return info

    def every(self) -> dict[str, Any]:
        """Those of all environments, as `gymnasium.vector.VectorEnv` gives them.

        Returns:
            Arrays (n, ...), with masks; the caller's own, as the loop goes on with others.
        """
        return self._masked(self._simulation.hand_over().named(self._terms), slice(None))

    def some(self, rows: np.ndarray) -> dict[str, Any]:
        """Those of some environments (m,); elsewhere masks are False. Nothing of none."""
        return self._masked(self._rooms.fill(rows, self._simulation.told), rows) if rows.size else {}

    def _masked(self, infos: dict[str, Any], rows: np.ndarray | slice) -> dict[str, Any]:
        """Each info with a mask beside it that says which environments have it, as Gymnasium asks for."""
        masks = np.zeros((len(infos) + len(self._terms), self._simulation.n), dtype=bool)
        masks[:, rows] = True
        left = iter(masks)
        terms = _beside(infos["reward_terms"], left)
        return _beside({**infos, "reward_terms": terms}, left)


def _beside(infos: dict[str, Any], masks: Iterator[np.ndarray]) -> dict[str, Any]:
    return {**infos, **{f"_{name}": next(masks) for name in infos}}


def final(observations: Observation, infos: dict[str, Any], rows: np.ndarray, n: int) -> dict[str, Any]:
    """Infos that hold the last observations and infos of episodes that are over.

    Args:
        observations: Of all environments.
        infos: Of those whose episodes are over.
        rows: Which these are, (m,).
        n: Environments.
    """
    if not rows.size:
        return {}
    last, over = np.full(n, None, dtype=object), np.zeros((2, n), dtype=bool)
    for i in rows.tolist():
        if isinstance(observations, dict):
            last[i] = {group: values[i].copy() for group, values in observations.items()}
        else:
            last[i] = observations[i].copy()
    over[:, rows] = True
    return {"final_obs": last, "_final_obs": over[0], "final_info": infos, "_final_info": over[1]}
