"""A memory of load over normal force in the last slip, and a controller that has no other friction."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from policies.controllers import table as controllers
from policies.controllers.base import Columns
from policies.controllers.gains import Gain, GainPolicy
from policies.controllers.sensing import both, scaled_load, scaled_speed
from slipgym.config import Overrides
from slipgym.config.base import Frozen, NonNegative, Positive
from slipgym.config.yaml_model import validate
from slipgym.envs.observation import FRICTION_COLUMNS


class SlipGains(Frozen):
    """Gains of noticing a slip."""

    speed: Positive = Gain(0.003, "Scaled slip speed that is a slip [m/s]")
    rest: NonNegative = Gain(12, "Control steps after a slip without another one [-]")


class SlipState(NamedTuple):
    """Memory of the slips, (n,) each; all 0 at the start."""

    mu_c: np.ndarray  # load over normal force in the last slip; 0 before the first [-]
    rest: np.ndarray  # control steps left without another slip


def remembered(columns: Columns, past: SlipState, r: np.ndarray | float, gains: SlipGains) -> SlipState:
    """The memory after the present observation.

    Args:
        columns: n observations.
        past: The memory before.
        r: Contact radius that scales torque and rate, (n,) or one for all [m]. In a turn without a slide
            `mu_c` times r is the torque per normal force, whatever r is.
        gains: When a slip is noticed.
    """
    slips = (scaled_speed(columns, r) > gains.speed) & (past.rest <= 0.0)
    shown = scaled_load(columns, r) / np.maximum(both(columns, "f_n"), 1e-3)
    return SlipState(
        mu_c=np.where(slips, shown, past.mu_c), rest=np.where(slips, gains.rest, past.rest - 1.0)
    )


def weight_of(shown: np.ndarray, deviation: np.ndarray, own: float) -> np.ndarray:
    """Weight of what forces showed against an estimate, by their variances, (n,) in [0, 1].

    Args:
        shown: Friction by the forces in a slip or while the object held, (n,); 0: none yet.
        deviation: Relative standard deviation of the estimate, (n,) [-]; 0 for friction that is known.
        own: That of `shown` [-].
    """
    square = deviation**2
    return np.where(shown > 0.0, square / np.maximum(square + own**2, 1e-30), 0.0)


def combined(estimate: np.ndarray, shown: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Weighted geometric mean of an estimate and what forces showed, (n,)."""
    return np.where(weight > 0.0, estimate ** (1.0 - weight) * np.maximum(shown, 1e-12) ** weight, estimate)


class SlipMemoryGains(SlipGains):
    """Gains of `SlipMemory`."""

    ratio: Positive = Gain(1.45, "mu_s over mu_c, as of the materials at hand [-]")


class SlipMemory:
    """A controller in an environment whose observation has no friction part, with a memory of slips.

    When the slip velocity rises, load over normal force is taken for mu_c, `ratio` times it for mu_s and the
    controller's prior for r, each in full confidence; before the first slip the controller reads friction
    values with confidence 0. It is the simplest policy that sees sensors alone and adapts: an opponent of the
    estimators. A controller that remembers slips by itself, as those that lift and Hinge do, always reads
    confidence 0, and no gain has an effect.

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
        self.modes = {"action_mode": made.action_mode}

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
