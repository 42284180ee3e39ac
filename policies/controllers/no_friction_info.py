"""A controller that never learns anything about friction."""

from __future__ import annotations

from typing import Any

import numpy as np

from policies.controllers import table as controllers
from slipgym.config import Overrides
from slipgym.envs.observation import FRICTION_COLUMNS


class NoFrictionInfo:
    """A controller in an environment that says nothing about friction.

    It sees what an estimator says before the first slip: values that no data supports. Every controller then
    acts on its cautious friction (`policies.controllers.sensing.Caution`), here for the whole episode. Those
    that would look for friction do not: their class says in `unaware` what they are made with.

    Args:
        controller: A name of `policies.names()` or "module:class"; none that is learned.
        config: Overrides of the environment's configuration.
        **parameters: Of the controller's class.
    """

    def __init__(self, controller: str, config: Overrides | None = None, **parameters: Any) -> None:
        given = getattr(controllers.find(controller), "unaware", {})
        self._controller = controllers.make(controller, {"config": config, **given, **parameters})
        self.modes = {"action_mode": self._controller.action_mode}

    def initial_state(self, n: int) -> Any:
        """See `policies.controllers.base.ForcePolicy.initial_state`."""
        return self._controller.initial_state(n)

    def predict(
        self,
        observation: np.ndarray,
        state: Any = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, Any]:
        """See `policies.Policy.predict`; the observations are those of friction_source="none"."""
        observation = np.asarray(observation)
        unsupported = np.zeros((*observation.shape[:-1], len(FRICTION_COLUMNS)), observation.dtype)
        seen = np.concatenate([observation, unsupported], axis=-1)
        return self._controller.predict(seen, state, episode_start, deterministic)
