"""Holds an object against disturbances with little force."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from policies.controllers import friction_fall
from policies.controllers.base import Columns, State
from policies.controllers.exploration import ActiveExploration, ExplorationState
from policies.controllers.friction_fall import PUSH, FallState
from policies.controllers.gains import Fraction, Gain, GainPolicy, renamed
from policies.controllers.sensing import ConservativePrior, both, relative, scaled_load, scaled_speed
from slipgym.config import Overrides
from slipgym.config.base import Frozen, NonNegative, Positive

_EXPLORATION = ActiveExploration()
_FIRST = 0.003  # confidence of a relative deviation of 1.8
_OWN = 1 + len(ExplorationState._fields)  # columns of the memory ahead of `FallState`


class HoldGains(Frozen):
    """Gains of `HoldPolicy`."""

    reserve: NonNegative = Gain(1.0, "Disturbance per finger to be ready for [N]")
    margin: Positive = Gain(1.0, "Safety factor on load and reserve [-]")
    stale: Positive = Gain(
        1.15, "Grip where friction is an estimate, which may have fallen since, over the usual [-]"
    )
    k_v: NonNegative = Gain(100.0, "Force per scaled slip speed [N s/m]")
    decay: Fraction = Gain(0.95, "Fraction of the force that is left a control step later when it falls [-]")
    doubt: NonNegative = Gain(
        0.95, "Load over grip in a slip, over mu_c, below which friction has fallen; 0: never [-]"
    )
    jolt: NonNegative = Gain(
        0.08, "Rise of the load in a control step that is a push, at least [N]; without `doubt` none is"
    )
    brace: Positive = Gain(6.0, "Grip in the control step after a push, over the usual [-]")


class HoldPolicy(GainPolicy[HoldGains]):
    """Grip as hard as the load needs at Coulomb friction, with room for a disturbance.

        f = margin (|load| + reserve) / mu_c + k_v |slip twist|

    in the scaled norm of the limit surface, with a low quantile of mu_c and r if the environment shows their
    deviations. Estimated friction may have fallen since the last slip, which no deviation covers: then the
    grip is `stale` times as firm, and the quantile is not as low as in other controllers. The force rises at
    once and decays slowly. The gripper's public controller doubles the load instead (and assumes at least
    2 N); a reserve that is added serves light objects, which a poke upsets more, and spares heavy ones.

    While friction is not known it explores: it lowers the grip until the object slips a little
    (`policies.controllers.exploration`), and then holds with the new estimate and with what the exploration
    showed. The task does not poke the object at first, and the earlier friction is known, the longer force is
    saved. With full confidence in the observed friction it never explores.
    The object may slip in a grip that should hold it, since its friction has fallen. The grip then closes as
    fast as it can, and friction is taken to be no more than was measured in that slip
    (`policies.controllers.friction_fall`), whatever the estimator makes of it. Such slips mostly begin with a
    push; so for one control step after any push, a fast rise of the load, the grip is braced.

    Args:
        gains: See `HoldGains`; each is a keyword argument of its own, too.
        exploration: How to explore; None: not at all, for as long as it does not slip by itself.
        prior: Friction assumed until the estimate has confidence; None: for as long as it has none if it
            explores, since it then holds on the first slip, and `ConservativePrior()` if not.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "Hold"
    Gains = HoldGains
    prior_default = ConservativePrior(confidence=_FIRST, deviations=0.3)
    needs_slip = False
    without_friction: ClassVar[Mapping[str, Any]] = {"exploration": None}

    def __init__(
        self,
        gains: HoldGains | None = None,
        exploration: ActiveExploration | None = _EXPLORATION,
        prior: ConservativePrior | None = None,
        config: Overrides | None = None,
        **parameters: Any,
    ) -> None:
        parameters = renamed(parameters)
        self.exploration = parameters.pop("exploration", exploration)
        if self.exploration is None:
            prior = prior or ConservativePrior()
        super().__init__(gains, prior, config, **parameters)

    def initial_state(self, n: int) -> np.ndarray:
        """Last level of the grip [N], 0 at the start, then `ExplorationState` and `FallState`, (n, 18)."""
        return np.column_stack((np.zeros((n, _OWN - 2)), np.ones(n), np.zeros(n), *friction_fall.begin(n)))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        g, memory = self.gains, np.asarray(state).T
        level, seen, past = memory[0], ExplorationState(*memory[1:_OWN]), FallState(*memory[_OWN:])
        r, normal = self.prior.hold(columns, "r"), both(columns, "f_n")
        load, speed = scaled_load(columns, r), scaled_speed(columns, r)
        unknown = columns["confidence_mu_c"] < self.prior.confidence
        if self.exploration is not None:
            seen = seen.holding(load, normal, unknown & (level > 0.0))
        assumed = self.prior.hold(columns, "mu_c")
        mu_c = seen.corrected(assumed, columns, least=assumed)
        settled = (level > 0.0) & (columns["confidence_mu_c"] >= self.prior.confidence)
        known = settled & (seen.rest == 0.0) & (g.doubt > 0.0)
        slip = columns["measured_slip_x"], columns["measured_slip_y"]
        catch, fall = friction_fall.notice(past, load, normal, speed, slip, g.doubt * mu_c, known)
        mu_c = np.minimum(mu_c, fall.bound)
        margin = np.where(relative(columns, "mu_c", mu_c) > 0.0, g.stale * g.margin, g.margin)
        force = margin * (load + g.reserve) / mu_c + g.k_v * speed
        command = force = np.maximum(force, g.decay * level)
        limits = self.config.gripper.force_min, self.config.gripper.force_max
        if self.exploration is not None:
            probes, lowered, lower, seen = self.exploration.act(
                seen, level, load, speed, level > 0.0, unknown, limits
            )
            command, force = np.where(probes, lowered, force), np.where(probes, lower, force)
        pushed = known & (load - past.load > np.maximum(g.jolt, PUSH * past.swing))
        command = np.where(pushed, g.brace * command, command)
        return np.where(catch, limits[1], command), np.column_stack((force, *seen, *fall))
