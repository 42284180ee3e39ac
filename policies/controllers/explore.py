"""Finds friction out: relaxes the grip until the object slips, and turns the wrist under it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from pydantic import Field

from estimator.estimate import deviation_of
from policies.controllers.base import Columns, State
from policies.controllers.gains import Fraction, GainPolicy
from policies.controllers.sensing import both, tangential
from slipgym.config.base import Frozen, NonNegative, Positive
from slipgym.envs.actions import GUESSED_DEVIATION

SETTLE, RELAX, REST, TURN, HOLD = range(5)
"""Phases: the load is averaged; the grip falls until the object slips; it rests; the wrist turns; the end."""
_NAMES = "mu_s", "mu_c", "r"


class ExploreState(NamedTuple):
    """Memory of an exploration, arrays (n,)."""

    phase: np.ndarray
    """One of the phases."""
    count: np.ndarray
    """Control steps since it began."""
    level: np.ndarray
    """Grip, but for the pulse that catches a slip [N]."""
    force: np.ndarray
    """Tangential force per finger at rest [N]."""
    torque: np.ndarray
    """Torque per finger at rest [N m]."""
    held: np.ndarray
    """Grip at which the last slip began [N]."""
    slips: np.ndarray
    """Slips caught so far."""
    turns: np.ndarray
    """Turns of the wrist so far."""
    rate: np.ndarray
    """Pitch rate of the wrist [rad/s]."""
    x: np.ndarray
    """Measured slip after the last control step [m]."""
    y: np.ndarray
    theta: np.ndarray
    """The same, the angle [rad]."""
    slid: np.ndarray
    """Path of the measured slip [m]."""
    turned: np.ndarray
    """Path of its angle [rad]."""


class ExploreGains(Frozen):
    """Gains of `ExplorePolicy`."""

    settle: NonNegative = Field(default=5, description="Control steps in which the load is averaged [-]")
    first: Positive = Field(default=4.0, description="Grip over load from which it is relaxed at first [-]")
    keep: Fraction = Field(default=0.94, description="Fraction of the grip left a control step later [-]")
    again: Positive = Field(
        default=1.2, description="Grip over that of the last slip from which it falls again [-]"
    )
    keep_again: Fraction = Field(default=0.98, description="Fraction left a control step later then [-]")
    fall: NonNegative = Field(default=0.1, description="Fall of the force that is a slip, over the force [-]")
    noise: NonNegative = Field(default=0.08, description="Fall of the force that is always noise [N]")
    speed: Positive = Field(default=2e-3, description="Speed that is a slip [m/s]")
    pulse: Positive = Field(
        default=6.0, description="Command in the control step of a catch, over the grip [-]"
    )
    catch: Positive = Field(default=1.6, description="Grip after a slip over that before [-]")
    rest: NonNegative = Field(default=5, description="Control steps at it [-]")
    margin: Positive = Field(default=2.0, description="mu_c times grip over load in a turn [-]")
    ready: NonNegative = Field(default=4, description="Control steps until that grip is reached [-]")
    turn: Positive = Field(default=2.6, description="Pitch rate of a turn [rad/s]")
    jerk: Positive = Field(default=1.2, description="Change of it in the first control step [rad/s]")
    push: Positive = Field(default=0.6, description="Change of it in those that follow [rad/s]")
    brake: Positive = Field(default=0.3, description="The same at its end, if the object is to stick [rad/s]")
    coast: NonNegative = Field(default=9, description="Control steps from the begin of a turn to its end [-]")
    slips: NonNegative = Field(default=3, description="Slips at least [-]")
    turns: NonNegative = Field(default=1, description="Turns at least [-]")
    sure: Positive = Field(default=0.025, description="Relative deviation with which a value is known [-]")
    ratio: Positive = Field(default=1.4, description="mu_s over mu_c until mu_c is known [-]")
    slide: NonNegative = Field(default=1.6e-3, description="Path of the slip after which it rests [m]")
    twist: NonNegative = Field(default=0.08, description="Path of the angle that turns may reach [rad]")


class ExplorePolicy(GainPolicy[ExploreGains]):
    """Let the object slip in short bursts, by a falling grip and by turns of the wrist.

    The grip falls until the object slips, which shows in the tangential force at the next control step; a
    pulse of the grip catches it after a tenth of a millimetre or two. The estimator learns mu_s from the
    load at which the slip began and mu_c from the slip. The next falls begin just above the grip of the
    last slip and are slower, so that few samples show mu_s well.

    r needs a slip that turns. In a firm grip the wrist accelerates in pitch faster than friction can take
    the object along:

        alpha > margin L r sqrt(1 - 1 / margin^2) / (I / 2)

    with the load L per finger. The object turns in the grip by a degree or two, while its weight slides
    it a little, and comes to rest on the turning wrist, which then brakes so slowly that it sticks, or as
    fast again if the deviation of mu_c or r is still larger than `sure`. The turn begins in the direction
    in which the torque of the weight helps friction. A slip that begins so fast shows no mu_s; its
    deviation is stated as 1 until `slips` slips were caught.

    It goes on until all deviations are at most `sure` or the path of the measured slip is `slide`, and
    then rests. Friction without confidence is what the grip at the last slip shows. It reads the
    deviations of the estimates, and where the environment does not show them the confidences of the
    estimator "adaptive".

    Args:
        gains: See `ExploreGains`; each is a keyword argument of its own, too.
        prior: Friction assumed until the estimate has confidence or a slip shows it.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: A parameter or the configuration is not valid.
    """

    task = "Explore"
    action_mode = "grip_force_wrist_guess"
    Gains = ExploreGains

    def initial_state(self, n: int) -> np.ndarray:
        """`ExploreState`, (n, 14)."""
        return np.zeros((n, len(ExploreState._fields)))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force, wrist velocity and guess, (n, 10), see `ForcePolicy.control`."""
        g, s = self.gains, self._measured(columns, ExploreState(*np.asarray(state).T))
        (mu_s, mu_c, r), deviations = self._friction(columns, s), self._deviations(columns)
        deviations[0] = np.where((s.slips < g.slips) & (deviations[0] > 0.0), 1.0, deviations[0])
        load = np.hypot(s.force, s.torque / r)

        settled = (s.phase == SETTLE) & (s.count >= g.settle)
        slips = self._slips(columns, s) & (s.phase == RELAX) & (s.count > 2)
        blurred = np.maximum(deviations[1], deviations[2]) > g.sure
        rate, turned = self._rate(s, blurred & (2.0 * s.turned < g.twist))
        free = settled | turned | ((s.phase == REST) & (s.count >= g.rest))
        turn = free & (s.slips > 0) & ((s.turns < g.turns) | blurred)
        turn &= s.turned * (1.0 + 1.0 / np.maximum(s.turns, 1.0)) < g.twist
        relax = free & ~turn & ((s.slips < g.slips) | (deviations[0] > g.sure)) & (s.slid < g.slide)
        hold = free & ~turn & ~relax

        keep = np.where(s.slips > 0, g.keep_again, g.keep)
        level = np.where(slips, g.catch, np.where(s.phase == RELAX, keep, 1.0)) * s.level
        begin = np.where(s.slips > 0, g.again * s.held, g.first * load)
        level = np.where(relax, begin, np.where(turn, g.margin * load / mu_c, level))
        level = np.where(hold, g.catch * load / mu_c, level)
        force = np.where(slips, g.pulse * level, level)
        force = np.where((s.phase == SETTLE) & ~settled, columns["commanded_force"], force)

        phase = s.phase
        for chosen, new in ((relax, RELAX), (slips, REST), (turn, TURN), (hold, HOLD)):
            phase = np.where(chosen, new, phase)
        s = s._replace(
            phase=phase, count=np.where(phase == s.phase, s.count + 1.0, 0.0) * ~turn, level=level, rate=rate,
            held=np.where(slips, s.level, s.held), slips=s.slips + slips, turns=s.turns + turned,
        )  # fmt: skip
        still = np.zeros(len(columns))
        guess = np.log([mu_s, mu_c, r, *np.clip(deviations, *GUESSED_DEVIATION)]).T
        return np.column_stack((force, still, still, rate, guess)), np.column_stack(s)

    def _measured(self, columns: Columns, s: ExploreState) -> ExploreState:
        """Adds what the sensors show: the load at rest and the paths of the slip."""
        x, y, theta = (columns[f"measured_slip_{name}"] for name in ("x", "y", "theta"))
        slid, turned = s.slid + np.hypot(x - s.x, y - s.y), s.turned + np.abs(theta - s.theta)
        weight = np.where(s.phase == SETTLE, 1.0 / (s.count + 1.0), 0.0)
        force = s.force + weight * (tangential(columns) - s.force)
        torque = s.torque + weight * (both(columns, "tau") - s.torque)
        return s._replace(x=x, y=y, theta=theta, slid=slid, turned=turned, force=force, torque=torque)

    def _slips(self, columns: Columns, s: ExploreState) -> np.ndarray:
        """Whether the object slips, (n,): the force falls at once, the speed shows later."""
        fell = s.force - tangential(columns) > np.maximum(self.gains.fall * s.force, self.gains.noise)
        return fell | (np.hypot(both(columns, "v_x"), both(columns, "v_y")) > self.gains.speed)

    def _rate(self, s: ExploreState, again: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pitch rate of the wrist (n,) [rad/s], and whether a turn has ended.

        It rises faster than friction lets the object follow. At the end of the turn it falls as fast where
        the object is to slip `again`, else so slowly that it does not.
        """
        g, way = self.gains, np.where((s.turns % 2 == 0) == (s.torque <= 0.0), 1.0, -1.0)
        since, size = s.count - g.ready, np.abs(s.rate)
        begins, ends = (s.phase == TURN) & (since >= 0), (s.phase == TURN) & (since >= g.coast)
        change = np.where((since == 0) | (since == g.coast), g.jerk, g.push)
        slower = np.maximum(size - np.where(again, change, g.brake), 0.0)
        new = np.where(ends, slower, np.minimum(size + change, g.turn))
        return np.where(begins, way * new, s.rate), ends & (size == 0.0) & (since >= g.coast + g.rest)

    def _friction(self, columns: Columns, s: ExploreState) -> tuple[np.ndarray, ...]:
        """mu_s, mu_c and r: the observed ones, or what the last slip shows where they have no confidence.

        Its grip shows mu_s, and `ratio` mu_c from that; r is the prior's. Shape (n,) each.
        """
        prior, known = self.prior, {name: columns[f"confidence_{name}"] > 0.0 for name in _NAMES}
        r = np.where(known["r"], columns["r"], prior.r)
        load = np.hypot(s.force, s.torque / r)
        shown = np.where(s.slips > 0, load / np.maximum(s.held, self.config.gripper.force_min), prior.mu_c)
        mu_s = np.where(known["mu_s"], columns["mu_s"], shown)
        return mu_s, np.where(known["mu_c"], columns["mu_c"], shown / self.gains.ratio), r

    def _deviations(self, columns: Columns) -> np.ndarray:
        """Relative standard deviations of mu_s, mu_c and r; 1 without confidence, (3, n)."""
        found = []
        for name in _NAMES:
            confidence = columns[f"confidence_{name}"]
            if columns.has(f"sd_{name}"):
                deviation = columns[f"sd_{name}"] / np.maximum(columns[name], 1e-9)
            else:
                deviation = deviation_of(np.clip(confidence, 1e-6, 1.0))
            found.append(np.where(confidence > 0.0, np.minimum(deviation, 1.0), 1.0))
        return np.array(found)
