"""Holding an object against disturbances with little force."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from policies.controllers.base import Columns, ForcePolicy, State
from policies.controllers.exploration import Probe, ProbeState
from policies.controllers.sensing import Caution, scaled_load, scaled_speed
from slipgym.config import Overrides

_PROBE = Probe()
_FIRST = 0.01  # support: less than that of one update, 0.02


class HoldPolicy(ForcePolicy):
    """Grip as hard as the load needs at Coulomb friction, with room for a disturbance.

        f = margin (|load| + reserve) / mu_c + k_v |slip twist|

    in the scaled norm of the limit surface. The force rises at once and decays slowly. The
    gripper's public controller doubles the load instead (and assumes at least 2 N); a reserve
    that is added serves light objects, which a poke upsets more, and spares heavy ones.

    Where nothing is known about friction it begins by lowering the grip until the object slips a little
    (`policies.controllers.exploration`), and holds on what the estimator learns from that. It is not poked at
    first, and the earlier friction is known the longer it saves force. Told friction with full support, it
    never probes.
    Probing is for estimators whose first update is the answer, "disc" and "joint": "rls" and "ukf" go there
    step by step from a start value, and what they say after a slip or two holds less than the load.

    Args:
        reserve: Disturbance per finger to be ready for [N].
        margin: Safety factor on load and reserve [-].
        k_v: Force per scaled slip speed [N s/m].
        decay: Share of the force kept per sample when it falls, in [0, 1).
        caution: Friction assumed until the estimate has support; None: for as long as it has none if it
            probes, since it then holds on the first slip, and `Caution()` if not.
        probe: How to find friction out; None: not at all, for as long as it does not slip by itself.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "Hold"
    unaware: ClassVar[Mapping[str, Any]] = {"probe": None}

    def __init__(
        self,
        reserve: float = 1.0,
        margin: float = 1.0,
        k_v: float = 100.0,
        decay: float = 0.95,
        caution: Caution | None = None,
        probe: Probe | None = _PROBE,
        config: Overrides | None = None,
    ) -> None:
        super().__init__(config)
        if not 0.0 <= decay < 1.0:
            raise ValueError(f"decay = {decay!r} must lie in [0, 1)")
        self.reserve, self.margin, self.k_v, self.decay = reserve, margin, k_v, decay
        self.caution = caution or (Caution() if probe is None else Caution(support=_FIRST))
        self.probe = probe

    def initial_state(self, n: int) -> np.ndarray:
        """Level of the grip in the last sample [N], 0 before the first, and the probe's memory, (n, 5)."""
        state = np.zeros((n, 1 + len(ProbeState._fields)))
        state[:, -1] = 1.0
        return state

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        mu_c, r = self.caution.blend(columns, "mu_c"), self.caution.blend(columns, "r")
        load, speed = scaled_load(columns, r), scaled_speed(columns, r)
        level, *rest = np.asarray(state).T
        force = self.margin * (load + self.reserve) / mu_c + self.k_v * speed
        force = np.maximum(force, self.decay * level)
        if self.probe is None:
            return force, np.column_stack([force, *rest])
        begun, memory = level > 0.0, ProbeState(*rest)
        memory = memory._replace(load=np.where(begun, memory.load, load))
        wanted = begun & (columns["confidence_mu_c"] < self.caution.support)
        slips = self.probe.slipping(memory, load, speed)
        limits = self.config.gripper.force_min, self.config.gripper.force_max
        probes, command, lower, memory = self.probe.act(memory, level, slips, wanted, limits)
        memory = memory._replace(load=memory.load + self.probe.smoothing * (load - memory.load))
        level = np.where(probes, lower, force)
        return np.where(probes, command, force), np.column_stack([level, *memory])
