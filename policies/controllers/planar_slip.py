"""Brings the object to a pose (x, y, theta) in the grip by gravity, wrist and grip force."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from policies.controllers import leaps
from policies.controllers.base import Columns, State
from policies.controllers.gains import Gain
from policies.controllers.leaps import LeapGains, LeapState, Slip
from policies.controllers.planar_plan import (
    Motion,
    Pair,
    PlanarPlanPolicy,
    PlanGains,
    PlanState,
    PositivePair,
    turned,
)
from policies.controllers.planar_slip_continuous import ContinuousPlanarSlipPolicy, SlipState
from policies.controllers.sensing import scaled_load, scaled_speed
from slipgym.config import Overrides
from slipgym.config.base import NonNegative, Positive


class Choice(NamedTuple):
    """Kind of slip of the object, (n,) each; all 0 at the start."""

    continuous: np.ndarray  # 1 in continuous slips, 0 in leaps
    waited: np.ndarray  # control steps since the first leap began, until the velocity shows it
    delay: np.ndarray  # as many as it took; 0 before


_PLAN, _LEAPS, _SLIPS, _CHOICE = (len(each._fields) for each in (PlanState, LeapState, SlipState, Choice))


class PlanarSlipGains(PlanGains, LeapGains):
    """Gains of `PlanarSlipPolicy`, those of the leaps among them; pairs are of slide and turn."""

    least: Pair = Gain((0.0009, 0.02), "Least slide [m] and turn [rad] to begin; it stops at half")
    creep: NonNegative = Gain(
        4.8e-5, "Creep of the pads per radian of a turn, times the lever of the centre of mass [m^2]"
    )
    pace: PositivePair = Gain((0.006, 0.12), "Mean slide speed [m/s] and turn rate [rad/s] in leaps")
    reserve: NonNegative = Gain(1.5, "Time that the wrist and the rest between the stages take [s]")
    prompt: NonNegative = Gain(
        0.026,
        "Time from the fall of the force until the velocity shows it, up to which slips may go on [s]",
    )
    seen: Positive = Gain(0.004, "Scaled slip speed that shows a leap [m/s]")


class PlanarSlipPolicy(PlanarPlanPolicy[PlanarSlipGains]):
    """The plan of `PlanarPlanPolicy` in leaps that the force begins and ends (`policies.controllers.leaps`).

    A leap needs no prompt velocity, so the slip sensor may be late by an unknown number of samples; after
    each leap the object rests until the sensor has shown it. Friction of the observation sets the grip that
    holds and the one from which the first break-away is looked for; then the last break-away counts.

    Leaps take time. Where they would take more than is left, that is slide / pace + turn / pace + reserve,
    the next slip is one of `ContinuousPlanarSlipPolicy`, which is faster and needs a prompt velocity. So it
    begins with a leap and counts the control steps from the fall of the force until the velocity shows it; if
    they are more than `prompt`, it goes on in leaps. The choice is made anew before each slip and after each
    leap.

    The creep of a turn is larger in leaps than r^2 per radian over |b|, as in steady slip; `creep` is the
    mean of what was found in simulation with contact radii of 4 to 5 mm.
    """

    Gains = PlanarSlipGains
    Slips = LeapState

    def _prepare(self, config: Overrides | None) -> None:
        self._leaps = leaps.at_rate(self.gains, self.config.physics.control_rate)
        self._continuous = ContinuousPlanarSlipPolicy(prior=self.prior, config=config)

    def initial_state(self, n: int) -> np.ndarray:
        """Columns of `PlanState`, `LeapState`, `SlipState` and `Choice`, (n, 25)."""
        plan, slips, choice = np.zeros((n, _PLAN)), np.zeros((n, _SLIPS)), np.zeros((n, _CHOICE))
        return np.column_stack((plan, *leaps.begin(n, self._leaps), slips, choice))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger and wrist velocity, (n, 4) [N, m/s, m/s, rad/s]."""
        memory = np.asarray(state)
        plan, in_leaps, slips, choice = np.split(memory, np.cumsum((_PLAN, _LEAPS, _SLIPS)), axis=1)
        past, last, chosen = PlanState(*plan.T), LeapState(*in_leaps.T), Choice(*choice.T)
        prompt = (chosen.delay > 0.0) & (chosen.delay <= self.gains.prompt / self._dt)
        fast = prompt & self._short_of_time(columns, past)
        begins = (last.clock == 0.0) & ((past.slipping == 0.0) | (chosen.continuous == 0.0))
        continuous = np.where(begins, fast, chosen.continuous > 0.0)[:, None]
        leap, leapt = super().control(columns, np.column_stack((plan, in_leaps)))
        slip, slipped = self._continuous.control(columns, np.column_stack((plan, slips)))
        after_leap, after_slip = np.asarray(leapt), np.asarray(slipped)
        plan = np.where(continuous, after_slip[:, :_PLAN], after_leap[:, :_PLAN])
        in_leaps = np.where(continuous, in_leaps, after_leap[:, _PLAN:])
        slips = np.where(continuous, after_slip[:, _PLAN:], 0.0)
        choice = self._observed(columns, chosen, LeapState(*in_leaps.T))._replace(continuous=continuous[:, 0])
        return np.where(continuous, slip, leap), np.column_stack((plan, in_leaps, slips, *choice))

    def _observed(self, columns: Columns, chosen: Choice, leaping: LeapState) -> Choice:
        """Counts the control steps of the first leap until the velocity shows it."""
        waits = (chosen.delay == 0.0) & ((chosen.waited > 0.0) | (leaping.clock > 0.0))
        waited = np.where(waits, chosen.waited + 1.0, chosen.waited)
        shown = waits & (scaled_speed(columns, self.prior.blend(columns, "r")) > self.gains.seen)
        return chosen._replace(waited=waited, delay=np.where(shown, waited, chosen.delay))

    def _short_of_time(self, columns: Columns, past: PlanState) -> np.ndarray:
        """Whether leaps would take more time than is left, (n,)."""
        x, y = turned((columns["target_x"], columns["target_y"]), -columns["target_theta"])
        at = turned((past.x, past.y), -columns["measured_slip_theta"])
        slide = np.hypot(x - at[0], y - at[1])
        turn = np.abs(columns["target_theta"] - columns["measured_slip_theta"])
        needed = slide / self.gains.pace[0] + turn / self.gains.pace[1] + self.gains.reserve
        return needed > columns["time_left"]

    def creep(self, left: np.ndarray, r: np.ndarray) -> np.ndarray:
        """See `PlanarPlanPolicy.creep`."""
        return self.gains.creep * left

    def interruptible(self, slips: LeapState) -> np.ndarray:
        """Between leaps, once they have been measured."""
        return slips.clock == 0.0

    def slip(
        self, columns: Columns, slips: LeapState, motion: Motion, begins: np.ndarray, r: np.ndarray
    ) -> tuple[np.ndarray, LeapState]:
        """See `PlanarPlanPolicy.slip`."""
        asked = Slip(
            wanted=motion.wanted,
            begins=begins,
            turning=motion.turning,
            distance=motion.distance,
            load=scaled_load(columns, r),
            speed=scaled_speed(columns, r),
            f_slip=1.0 / self.prior.blend(columns, "mu_c"),
            held=motion.held,
        )
        return leaps.leap(slips, asked, self._leaps, self.config.gripper.force_max)
