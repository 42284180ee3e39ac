"""Runs a controller without friction information that remembers load over normal force of the last slip."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import Field

from policies.controllers import table as controllers
from policies.controllers.base import Columns
from policies.controllers.gains import GainPolicy
from policies.controllers.last_slip import SlipGains, SlipState, remembered
from policies.registry import modes
from slipgym.config import Overrides
from slipgym.config.base import Positive
from slipgym.config.yaml_model import validate
from slipgym.envs.observation import FRICTION_COLUMNS


class SlipMemoryGains(SlipGains):
    """Gains of `SlipMemory`."""

    ratio: Positive = Field(default=1.45, description="mu_s over mu_c, as of the materials at hand [-]")


class SlipMemory:
    """A controller in an environment whose observation has no friction part, with a memory of slips.

    When the slip velocity rises, load over normal force is taken for mu_c, `ratio` times it for mu_s and the
    controller's prior for r, each in full confidence; before the first slip the controller reads friction
    values with confidence 0. It is the simplest policy that sees sensors alone and adapts: an opponent of the
    estimators. A controller that remembers slips by itself, as those that lift do, always reads confidence 0.

    Args:
        controller: A name of `policies.names()` or "module:class": a controller with gains and a prior.
        config: Overrides of the environment's configuration.
        **parameters: Gains, see `SlipMemoryGains`.

    Raises:
        ValueError: A name or value is not valid.
    """

    def __init__(self, controller: str, config: Overrides | None = None, **parameters: Any) -> None:
        made = controllers.make(controller, {"config": config})
        if not isinstance(made, GainPolicy):
            raise ValueError(f"controller = {controller!r} reads no friction: it has no prior")
        self._controller = made
        self._gains = validate(parameters, SlipMemoryGains, "SlipMemory")
        self.modes = {"action_mode": modes(self._controller)["action_mode"]}

    def predict(
        self,
        observation: np.ndarray,
        state: Any = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, Any]:
        """See `policies.Policy.predict`; the observations are those of friction_source="none"."""
        observations = np.atleast_2d(np.asarray(observation))
        fresh = np.zeros((len(observations), len(SlipState._fields)))
        inner, slips = (None, fresh) if state is None else state
        if episode_start is not None:
            slips = np.where(np.atleast_1d(episode_start)[:, None], 0.0, slips)
        r = np.full(len(observations), self._controller.prior.r)
        memory = remembered(
            Columns(observations, self._controller.index), SlipState(*slips.T), r, self._gains
        )
        known = (memory.mu_c > 0.0) & (not self._controller.remembers_slips)
        values = self._gains.ratio * memory.mu_c, memory.mu_c, r
        part = np.column_stack([*values, *(known for _ in FRICTION_COLUMNS[len(values) :])])
        seen = np.column_stack((observations, part)).astype(observations.dtype)
        actions, inner = self._controller.predict(seen, inner, episode_start, deterministic)
        return (actions if np.ndim(observation) == 2 else actions[0]), (inner, np.column_stack(memory))
