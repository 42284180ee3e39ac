"""A controller under a learner that only changes its actions: residual policy learning.

T. Silver, K. Allen, J. Tenenbaum, L. Kaelbling, Residual policy learning, arXiv 1812.06298; T. Johannink et
al., Residual reinforcement learning for robot control, arXiv 1812.03201.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from policies.controllers import table as controllers
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.controllers.rate import at_rate
from policies.learned.description import Residual
from slipgym.envs.arguments import DEFAULT_ESTIMATOR, friction_part


class Underlying:
    """The controller of a residual policy, reading the newest of the observations that the learner reads.

    Args:
        residual: The controller, and how far its actions may be changed.
        arguments: Keyword arguments of the environment; without friction, the controller is `NoFrictionInfo`.
        columns: Numbers in one observation, without the earlier ones.
        rate: Actions per second.

    Raises:
        ValueError: The controller has no such parameter.
    """

    def __init__(self, residual: Residual, arguments: Mapping[str, Any], columns: int, rate: float) -> None:
        name, config = residual.controller, at_rate(rate, arguments.get("config"))
        self._columns, self._reach = columns, np.float32(residual.reach)
        source = arguments.get("friction_source", "estimated")
        if friction_part(source, arguments.get("estimator", DEFAULT_ESTIMATOR)) == "none":
            self._controller: Any = NoFrictionInfo(name, config, **residual.parameters)
        else:
            self._controller = controllers.make(name, {**residual.parameters, "config": config})

    @property
    def memory(self) -> int:
        """Numbers in the controller's memory."""
        return sum(part.shape[1] for part in _parts(self._controller.initial_state(1)))

    def act(
        self, observations: np.ndarray, state: Any, starts: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, Any]:
        """The controller's action.

        Args:
            observations: As the environment gives them, earlier ones first in each, (n, m).
            state: The controller's memory; None before the first call.
            starts: Which rows begin an episode, (n,) bool; None: none but before the first call.

        Returns:
            Its actions (n, k); what the learner reads: observations, actions and memory, float32; the memory.
        """
        actions, state = self._controller.predict(observations[:, -self._columns :], state, starts)
        read = np.concatenate([observations, actions, *_parts(state)], axis=1, dtype=np.float32)
        return actions, read, state

    def changed(self, actions: np.ndarray, change: np.ndarray) -> np.ndarray:
        """Actions (n, k) with what the learner adds, its output being within [-1, 1]; float32."""
        return np.clip(actions + self._reach * change, -1.0, 1.0).astype(np.float32)


def _parts(state: Any) -> tuple[np.ndarray, ...]:
    return state if isinstance(state, tuple) else (state,)
