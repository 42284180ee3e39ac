"""Letting the object hang upright while the wrist pitches."""

from __future__ import annotations

import numpy as np

from policies.controllers.base import Columns, ForcePolicy, State
from policies.controllers.sensing import Caution, both, tangential
from slipgym.config import Overrides


class HingePolicy(ForcePolicy):
    """Grip as hard as keeps the object's tilt where slide and tilt are both allowed.

    With k = mu_c f_n / f_t the limit surface lets the object slide r / sqrt(k^2 - 1) per radian of the
    turn, and drags it to a tilt of about r sqrt(k^2 - 1) / d under its centre of mass, d deep. Neither r
    nor d needs to be known: the tilt itself, wrist pitch plus travel, says how k has to change.

        f = k f_t / mu_c,    k = k_slip + k_a (target - tilt) - k_w tilt',    within [k_min, k_max]

    The gripper's public controller holds k at 1.4 (arXiv 2410.19660). Until the object first turns in the
    grip it holds by static friction, which is larger: with the same k the wrist would take it along
    beyond what is allowed, and it would swing when it breaks away. So k is then k_stick, between 1 and
    mu_s / mu_c, and the first degrees of the turn show when friction lets go. Where friction is not known
    yet it is k_blind, by a cautious mu_c. What then still holds at the tilt `release` has a larger friction,
    and the grip falls with the tilt from there, so that it lets go in time.

    Args:
        k_stick: Ratio k before the object first turns in the grip [-].
        k_blind: The same by the cautious mu_c [-].
        release: Tilt from which that falls [rad].
        k_slip: Ratio k at the target tilt [-].
        k_min: Least ratio k while the object turns in the grip [-].
        k_max: Largest ratio k [-].
        k_a: Gain on the tilt [1/rad].
        k_w: Gain on its rate [s/rad].
        target: Tilt to hold [rad].
        onset: Travel from which the object counts as turning in the grip [rad].
        smoothing: Share of the old tangential force kept per sample, in [0, 1).
        caution: Friction assumed until the estimate has support; more than elsewhere, as the first samples
            after the break-away, near static friction, say too much.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "Hinge"

    def __init__(
        self,
        k_stick: float = 1.2,
        k_blind: float = 0.95,
        release: float = 0.05,
        k_slip: float = 2.0,
        k_min: float = 1.1,
        k_max: float = 3.0,
        k_a: float = 45.0,
        k_w: float = 6.0,
        target: float = 0.065,
        onset: float = 0.005,
        smoothing: float = 0.9,
        caution: Caution | None = None,
        config: Overrides | None = None,
    ) -> None:
        super().__init__(config)
        if not 0.0 <= smoothing < 1.0:
            raise ValueError(f"smoothing = {smoothing!r} must lie in [0, 1)")
        if not 0.0 < k_min <= k_max:
            raise ValueError(f"needs 0 < k_min <= k_max, got k_min = {k_min!r}, k_max = {k_max!r}")
        if not 0.0 < release < np.inf:
            raise ValueError(f"release = {release!r} must be finite and > 0")
        self.k_stick, self.k_blind, self.release = k_stick, k_blind, release
        self.k_slip, self.k_min, self.k_max = k_slip, k_min, k_max
        self.k_a, self.k_w, self.target, self.onset = k_a, k_w, target, onset
        self.smoothing = smoothing
        self.caution = caution or Caution(support=0.2)

    def initial_state(self, n: int) -> np.ndarray:
        """Filtered tangential force, (n, 1) [N]; a negative one has no sample yet."""
        return np.full((n, 1), -1.0)

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        old, load = np.asarray(state)[:, 0], tangential(columns)
        load = np.where(old < 0.0, load, self.smoothing * old + (1.0 - self.smoothing) * load)
        turned, side = columns["measured_slip_theta"], np.sign(columns["wrist_pitch_goal"])
        tilt = side * (columns["wrist_pitch"] + turned)
        rate = side * (columns["wrist_pitch_rate"] + both(columns, "omega"))
        k = self.k_slip + self.k_a * (self.target - tilt) - self.k_w * rate
        k = np.clip(k, self.k_min, self.k_max)
        trust = self.caution.trust(columns, "mu_c")
        blind = self.k_blind * self.release / np.maximum(np.abs(tilt), self.release)
        start = trust * self.k_stick + (1.0 - trust) * blind
        k = np.where(np.abs(turned) > self.onset, k, start)
        return k * load / self.caution.blend(columns, "mu_c"), load[:, np.newaxis]
