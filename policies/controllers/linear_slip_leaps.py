"""Controls linear slip along gravity by grip force alone, in leaps that the force begins and ends."""

from __future__ import annotations

import numpy as np

from policies.controllers import leaps
from policies.controllers.base import Columns, State
from policies.controllers.gains import Gain, GainPolicy
from policies.controllers.leaps import BEGUN, LeapGains, LeapState, Slip
from policies.controllers.sensing import scaled_speed, tangential
from slipgym.config import Overrides
from slipgym.config.base import Positive


class LinearSlipLeapGains(LeapGains):
    """Gains of `LinearSlipLeapPolicy`."""

    start: Positive = Gain(1.6, "Grip from which it falls to the first break-away, over f_slip [-]")
    again: Positive = Gain(1.2, "Ratio of the grip after a leap to the grip at the break-away [-]")
    slide: Positive = Gain(0.002, "Longest leap [m]")
    hold_margin: Positive = Gain(1.4, "Grip while holding, over the need [-]")


class LinearSlipLeapPolicy(GainPolicy[LinearSlipLeapGains]):
    """Follows the reference in leaps (`policies.controllers.leaps`), for a slip velocity that arrives late.

    "linear_slip" regulates the slip by its measured velocity: if that is late, the object is caught late. A
    leap begins when the force falls and ends after a planned time. The object then rests until the sensor has
    shown how long the leap was. There is another one if more is left than half of the shortest.
    """

    task = "LinearSlip"
    Gains = LinearSlipLeapGains

    def _prepare(self, config: Overrides | None) -> None:
        self._leaps = leaps.at_rate(self.gains, self.config.physics.control_rate)

    def initial_state(self, n: int) -> np.ndarray:
        """Whether a leap is wanted (0 or 1), last reference [m], columns of `LeapState`, (n, 11)."""
        return np.column_stack((np.zeros((n, 2)), *leaps.begin(n, self._leaps)))

    def caught(self, columns: Columns, load: np.ndarray) -> np.ndarray:
        """Memory, as of `initial_state`, as if a leap were caught now.

        Args:
            columns: n observations.
            load: Load per finger at rest, (n,) [N].
        """
        n, reference = len(columns), columns["reference_position"]
        slips = leaps.begin(n, self._leaps)._replace(
            load=load,
            ratio=self.gains.start / self.prior.blend(columns, "mu_c"),
            clock=np.full(n, -float(self._leaps.rest)),
            steps=np.full(n, float(self._leaps.slide_steps)),
            left=reference + columns["measured_slip_y"],
        )
        return np.column_stack((np.ones(n), reference, *slips))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger, (n,) [N]."""
        memory = np.asarray(state).T
        past, slips, reference = memory[0] > 0.0, LeapState(*memory[2:]), columns["reference_position"]
        left = reference + columns["measured_slip_y"]
        slips = slips._replace(left=slips.left + reference - memory[1])  # what a leap leaves does not grow
        worth = left > 0.5 * slips.reach * BEGUN**2
        between = (slips.clock == -1.0) | ((slips.clock == 0.0) & ~past)
        wanted = np.where(between, worth, past)
        load, never = tangential(columns), np.zeros(len(columns), dtype=bool)
        need = np.maximum(load / self.prior.hold(columns, "mu_c"), slips.ratio * slips.load)
        asked = Slip(
            wanted=wanted,
            begins=wanted & (slips.ratio == 0.0),
            turning=never,
            distance=left,
            load=load,
            speed=scaled_speed(columns, self.prior.blend(columns, "r")),
            f_slip=1.0 / self.prior.blend(columns, "mu_c"),
            held=self.gains.hold_margin * need,
        )
        force, slips = leaps.leap(slips, asked, self._leaps, self.config.gripper.force_max)
        return force, np.column_stack((wanted, reference, *slips))
