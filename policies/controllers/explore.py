"""Finds friction out: relaxes the grip until the object slips, and turns the wrist under it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np

from estimator.estimate import deviation_of
from policies.controllers.base import Columns, State
from policies.controllers.explore_gains import ExploreGains
from policies.controllers.force_friction import Events, Forces, Ratios, merge, solve, watch
from policies.controllers.gains import GainPolicy
from policies.controllers.sensing import both, relative, tangential
from slipgym.envs.actions import GUESSED_DEVIATION

SETTLE, HANG, RELAX, REST, TURN, HOLD = range(6)
"""Phases: the load is averaged; the wrist pitches until the weight has no torque; the grip falls until the
object slips; it rests; the wrist turns; the end."""
_NAMES = "mu_s", "mu_c", "r"


class ExploreState(NamedTuple):
    """Memory of an exploration, arrays (n,)."""

    phase: np.ndarray  # one of the phases
    count: np.ndarray  # control steps since it began
    level: np.ndarray  # grip, but for the pulse that catches a slip [N]
    force: np.ndarray  # tangential force per finger at rest [N]
    torque: np.ndarray  # torque per finger at rest [N m]
    held: np.ndarray  # grip at which the last slip began [N]
    slips: np.ndarray  # slips caught so far
    slow: np.ndarray  # 1 if the last slip began slowly, else 0
    turns: np.ndarray  # turns of the wrist so far
    rate: np.ndarray  # pitch rate of the wrist [rad/s]
    braking: np.ndarray  # 1 while the wrist brakes before the first slip, else 0
    x: np.ndarray  # measured slip after the last control step [m]
    y: np.ndarray
    theta: np.ndarray  # the same, the angle [rad]
    uneven: np.ndarray  # tangential force of finger 1 less that of finger 2, in the first grip [N]
    slid: np.ndarray  # path of the measured slip [m]
    turned: np.ndarray  # path of its angle [rad]


class ExplorePolicy(GainPolicy[ExploreGains]):
    """Let the object slip in short bursts, by a falling grip and by turns of the wrist.

    Where the weight has a torque, the wrist pitches first, in a firm grip, until the centre of mass is below
    the pads: then a break-away and a slide show mu_s and mu_c whatever the limit surface is. The grip falls
    until the object slips, which shows in the tangential force at the next control step; a pulse of the grip
    catches it after a tenth of a millimetre or two, where it slips slowly a control step later. The next
    falls begin just above the grip of the last slip and are slower.

    r needs a slip that turns. In a grip of `margin` times the load over mu_c the wrist accelerates in pitch
    faster than friction can take the object along:

        alpha > margin L r sqrt(1 - 1 / margin^2) / (I / 2)

    with the load L per finger. The object turns in the grip by a degree or two, while its weight slides
    it a little, and comes to rest on the turning wrist, which then brakes so slowly that it sticks, or as
    fast again if the deviation of mu_c or r is still larger than `sure`. The larger `margin`, the purer the
    turn, and the less r depends on the limit surface.

    The guess combines the observed friction with what the forces have shown (`force_friction`), each with the
    weight of its variance; its deviations are the smaller ones of both. That of mu_s is stated as 1 until
    `slips` slips were caught. Sensors count as tared; where the fingers carry unlike forces by more than
    noise, the sensors have errors, which half of it counts for.

    It goes on until all deviations are at most `sure` or the path of the measured slip is `slide`, and
    then rests. Friction without confidence is what the grip at the last slip shows. It reads the
    deviations of the estimates, and where the environment does not show them the confidences of the
    estimator "adaptive".
    """

    task = "Explore"
    action_mode = "grip_force_wrist_guess"
    Gains = ExploreGains
    remembers_slips = True
    without_friction: ClassVar[Mapping[str, Any]] = {"forces": False}

    def initial_state(self, n: int) -> tuple[np.ndarray, np.ndarray]:
        """`ExploreState`, (n, 17), and `Forces`, (n, 20)."""
        return np.zeros((n, len(ExploreState._fields))), np.zeros((n, 20))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force, wrist velocity and guess, (n, 10), see `ForcePolicy.control`."""
        g, s = self.gains, ExploreState(*np.asarray(state[0]).T)
        slips, fall = self._slips(columns, s)
        s = self._measured(columns, s, slips)
        seen = np.asarray(state[1]).T
        forces = Forces(*seen[:5], *(Ratios(*seen[k : k + 5]) for k in (5, 10, 15)))
        forces = self._watched(columns, forces, s, slips)
        slow = np.where(slips, fall < g.slow, s.slow)
        (mu_s, mu_c, r), deviations = self._known(columns, s, forces)
        load = np.hypot(s.force, s.torque / r)

        settled = (s.phase == SETTLE) & (s.count >= g.settle)
        hang = settled & (np.abs(s.torque) > g.lever * r * s.force)
        pitch, pitched = self._hang(columns, s, r)
        blurred = np.maximum(deviations[1], deviations[2]) > g.sure
        rate, turned = self._rate(s, blurred & (2.0 * s.turned < g.twist))
        free = (settled & ~hang) | pitched | turned | ((s.phase == REST) & (s.count >= g.rest))
        turn = free & (s.slips > 0) & ((s.turns < g.turns) | blurred)
        turn &= s.turned * (1.0 + 1.0 / np.maximum(s.turns, 1.0)) < g.twist
        unsure = deviations.max(axis=0) > g.sure
        relax = free & ~turn & ((s.slips < g.slips) | unsure) & (s.slid < g.slide)
        hold = free & ~turn & ~relax

        keep = np.where(s.slips > 0, g.keep_again, g.keep)
        caught = np.where(slow, (s.phase == REST) & (s.count == 0), slips)
        falls = (s.phase == RELAX) & ~slips
        level = np.where(caught, g.catch, np.where(falls, keep, 1.0)) * s.level
        begin = np.where(s.slips > 0, g.again * s.held, g.first * load)
        level = np.where(relax, begin, np.where(turn, g.margin * load / mu_c, level))
        level = np.where(hold, g.catch * load / mu_c, level)
        force = np.where(caught, g.pulse * level, level)
        waits = ((s.phase == SETTLE) | (s.phase == HANG)) & ~relax
        force = np.where(waits, columns["commanded_force"], force)
        rate = np.where(s.phase == HANG, pitch, rate)

        phase = s.phase
        for chosen, new in ((hang, HANG), (relax, RELAX), (slips, REST), (turn, TURN), (hold, HOLD)):
            phase = np.where(chosen, new, phase)
        s = s._replace(
            phase=phase, count=np.where(phase == s.phase, s.count + 1.0, 0.0) * ~turn, level=level, rate=rate,
            braking=(s.phase == HANG) & (np.abs(rate) < np.abs(s.rate)),
            held=np.where(slips, s.level, s.held), slips=s.slips + slips, slow=slow, turns=s.turns + turned,
        )  # fmt: skip
        still = np.zeros(len(columns))
        guess = np.log([mu_s, mu_c, r, *np.clip(deviations, *GUESSED_DEVIATION)]).T
        seen = (*forces[:5], *forces.static, *forces.slide, *forces.turn)
        memory = np.column_stack(s), np.column_stack(seen)
        return np.column_stack((force, still, still, rate, guess)), memory

    def _watched(self, columns: Columns, past: Forces, s: ExploreState, slips: np.ndarray) -> Forces:
        """Adds what the forces show."""
        events = Events(
            falls=np.where(s.phase == RELAX, s.count, -1.0),
            keep=np.where(s.slips > 0, self.gains.keep_again, self.gains.keep),
            slips=slips,
            slides=(s.phase == REST) & (s.count <= s.slow),
            turns=(s.phase == TURN) & (s.rate != 0.0),
            force=s.force,
            torque=s.torque,
            r=self._radius(columns),
        )
        return watch(columns, past, self.gains, events)

    def _radius(self, columns: Columns) -> np.ndarray:
        """Contact radius as observed, or the prior's without confidence, (n,) [m]."""
        return np.where(columns["confidence_r"] > 0.0, columns["r"], self.prior.r)

    def _known(self, columns: Columns, s: ExploreState, forces: Forces) -> tuple[np.ndarray, np.ndarray]:
        """mu_s, mu_c, r by the observed values and by forces, and their relative deviations, (3, n) each."""
        g, observed, deviations = self.gains, np.array(self._friction(columns, s)), self._deviations(columns)
        uneven = np.maximum(s.uneven**2 - (2.0 * g.sd_force) ** 2 / (g.settle + 1.0), 0.0)
        shared = np.sqrt(g.sd_shared**2 + 0.25 * uneven / np.maximum(s.force, 1e-3) ** 2)
        if not g.forces:
            return observed, deviations
        turn = forces.turn._replace(weight=np.where(s.turned > g.turned, forces.turn.weight, 0.0))
        own = solve(forces.static, forces.slide, turn, self._radius(columns), shared)
        values, merged = merge(observed, deviations, own)
        merged[0] = np.where((s.slips < g.slips) & (deviations[0] > 0.0), 1.0, merged[0])
        return values, merged

    def _measured(self, columns: Columns, s: ExploreState, slips: np.ndarray) -> ExploreState:
        """Adds what the sensors show: the load at rest and the paths of the slip."""
        x, y, theta = (columns[f"measured_slip_{name}"] for name in ("x", "y", "theta"))
        slid, turned = s.slid + np.hypot(x - s.x, y - s.y), s.turned + np.abs(theta - s.theta)
        first, falls = s.phase == SETTLE, (s.phase == RELAX) & ~slips
        mean = 1.0 / (s.count + 1.0)
        weight = np.where(first, mean, np.where(falls, self.gains.newest, 0.0))
        force = s.force + weight * (tangential(columns) - s.force)
        weight = np.where(first | falls, mean, 0.0)
        torque = s.torque + weight * (both(columns, "tau") - s.torque)
        one, two = (np.hypot(columns[f"f_x_{f}"], columns[f"f_y_{f}"]) for f in (1, 2))
        uneven = s.uneven + np.where(first, mean, 0.0) * (one - two - s.uneven)
        return s._replace(
            x=x, y=y, theta=theta, slid=slid, turned=turned, force=force, torque=torque,
            uneven=uneven,
        )  # fmt: skip

    def _slips(self, columns: Columns, s: ExploreState) -> tuple[np.ndarray, np.ndarray]:
        """Whether the object slips, and the fall of the force over it, (n,) each.

        The force falls at once, the speed shows later.
        """
        fall = s.force - tangential(columns)
        fell = fall > np.maximum(self.gains.fall * s.force, self.gains.noise)
        fast = np.hypot(both(columns, "v_x"), both(columns, "v_y")) > self.gains.speed
        return (fell | fast) & (s.phase == RELAX) & (s.count > 2), fall / np.maximum(s.force, 1e-3)

    def _hang(self, columns: Columns, s: ExploreState, r: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pitch rate of a wrist that brings the centre of mass below the pads, and whether it has, (n,) each.

        The grip is firm, and the rate changes so slowly that the object sticks.
        """
        g, size = self.gains, np.abs(s.rate)
        whole = size >= g.turn
        hangs = np.abs(both(columns, "tau")) < g.lever * r * s.force
        brakes = (s.count >= g.longest) | (whole & hangs) | (s.braking > 0.0)
        new = np.where(brakes, np.maximum(size - g.gently, 0.0), np.minimum(size + g.gently, g.turn))
        return np.where(s.torque <= 0.0, new, -new), (s.phase == HANG) & brakes & (size == 0.0)

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
            deviation = relative(columns, name, columns[name])
            if f"sd_{name}" not in columns:
                deviation = deviation_of(np.clip(confidence, 1e-6, 1.0))
            found.append(np.where(confidence > 0.0, np.minimum(deviation, 1.0), 1.0))
        return np.array(found)
