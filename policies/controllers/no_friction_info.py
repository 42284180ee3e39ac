"""Runs a controller without friction information."""

from __future__ import annotations

from typing import Any

import numpy as np

from policies.controllers import table as controllers
from slipgym.config import Overrides
from slipgym.envs.observation import FRICTION_COLUMNS


class NoFrictionInfo:
    """A controller in an environment whose observation has no friction part.

    The controller reads friction values with confidence 0, as before the first slip. It then acts on its
    conservative prior (`policies.controllers.sensing.ConservativePrior`) for the whole episode. Controllers
    that explore friction do not do so here: their class attribute `without_friction` has the arguments.

    Args:
        controller: A name of `policies.names()` or "module:class"; none that is learned.
        config: Overrides of the environment's configuration.
        **parameters: Of the controller's class.
    """

    def __init__(self, controller: str, config: Overrides | None = None, **parameters: Any) -> None:
        given = getattr(controllers.find(controller), "without_friction", {})
        self._controller = controllers.make(controller, {"config": config, **given, **parameters})
        self.modes = {"action_mode": self._controller.action_mode}

    def predict(
        self,
        observation: np.ndarray,
        state: Any = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, Any]:
        """See `policies.Policy.predict`; the observations are those of friction_source="none"."""
        observation = np.asarray(observation)
        unknown = np.zeros((*observation.shape[:-1], len(FRICTION_COLUMNS)), observation.dtype)
        seen = np.concatenate([observation, unknown], axis=-1)
        return self._controller.predict(seen, state, episode_start, deterministic)
