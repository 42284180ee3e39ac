"""Holding an object against disturbances with little force."""

from __future__ import annotations

import numpy as np

from policies.base import Columns, ForcePolicy, State
from policies.sensing import Caution, scaled_load, scaled_speed
from slipgym.config import Overrides


class HoldPolicy(ForcePolicy):
    """Grip as hard as the load needs at Coulomb friction, with room for a disturbance.

        f = margin (|load| + reserve) / mu_c + k_v |slip twist|

    in the scaled norm of the limit surface. The force rises at once and decays slowly. The
    gripper's public controller doubles the load instead (and assumes at least 2 N); a reserve
    that is added serves light objects, which a poke upsets more, and spares heavy ones.

    Args:
        reserve: Disturbance per finger to be ready for [N].
        margin: Safety factor on load and reserve [-].
        k_v: Force per scaled slip speed [N s/m].
        decay: Share of the force kept per sample when it falls, in [0, 1).
        caution: Friction assumed until the estimate has support.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "Hold"

    def __init__(
        self,
        reserve: float = 1.0,
        margin: float = 1.0,
        k_v: float = 100.0,
        decay: float = 0.95,
        caution: Caution | None = None,
        config: Overrides | None = None,
    ) -> None:
        super().__init__(config)
        if not 0.0 <= decay < 1.0:
            raise ValueError(f"decay = {decay!r} must lie in [0, 1)")
        self.reserve, self.margin, self.k_v, self.decay = reserve, margin, k_v, decay
        self.caution = caution or Caution()

    def initial_state(self, n: int) -> np.ndarray:
        """Force of the last sample, (n, 1) [N]."""
        return np.zeros((n, 1))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        mu_c, r = self.caution.blend(columns, "mu_c"), self.caution.blend(columns, "r")
        need = self.margin * (scaled_load(columns, r) + self.reserve) / mu_c
        force = need + self.k_v * scaled_speed(columns, r)
        force = np.maximum(force, self.decay * np.asarray(state)[:, 0])
        return force, force[:, np.newaxis]
