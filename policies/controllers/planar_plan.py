"""Plan of a motion to a pose (x, y, theta) in the grip, for controllers that let the object slip."""

from __future__ import annotations

from abc import abstractmethod
from typing import Annotated, Any, ClassVar, Generic, NamedTuple, TypeAlias, TypeVar

import numpy as np
from pydantic import BeforeValidator

from policies.controllers.base import Columns, State
from policies.controllers.gains import Gain, GainPolicy
from policies.controllers.sensing import ConservativePrior, both, tangential
from slipgym.config.base import Frozen, NonNegative, Positive, as_tuple

APPROACH, TURN, FINISH, TRIM, DONE = range(5)
"""Stages: slide, turn, slide the rest, turn the rest, hold."""

Point: TypeAlias = tuple[np.ndarray, np.ndarray]
Pair = Annotated[tuple[NonNegative, NonNegative], BeforeValidator(as_tuple)]
PositivePair = Annotated[tuple[Positive, Positive], BeforeValidator(as_tuple)]
_REST = (0.0006, 0.02)
"""Speed [m/s] and rate [rad/s] below which an object rests."""


class PlanState(NamedTuple):
    """Memory of the plan, (n,) each; all 0 at the start."""

    x: np.ndarray  # slip displacement along the pads' x axis [m]
    y: np.ndarray  # the same along their y axis [m]
    measured_slip_x: np.ndarray  # measured slip at the last control step [m]
    measured_slip_y: np.ndarray  # the same along y [m]
    measured_slip_theta: np.ndarray  # the same about the grip axis [rad]
    weight: np.ndarray  # filtered tangential force per finger [N]
    stage: np.ndarray  # one of the stages
    slipping: np.ndarray  # 1 while the object is let slip, 0 while it is held and the wrist turns
    side: np.ndarray  # sign of the turn


class Motion(NamedTuple):
    """Request of the plan to the grip, arrays (n,)."""

    turning: np.ndarray  # whether the object is to turn; else it is to slide
    distance: np.ndarray  # distance left [m or rad]
    speed: np.ndarray  # measured speed of the slide or rate of the turn [m/s or rad/s]
    wanted: np.ndarray  # whether the object is to slip
    held: np.ndarray  # grip that holds the object [N]


class PlanGains(Frozen):
    """Gains of the plan; pairs are of slide and turn."""

    least: Pair = Gain((0.0013, 0.03), "Least slide [m] and turn [rad] to begin; it stops at half")
    short: NonNegative = Gain(0.0015, "How far before its goal the first slide ends [m]")
    lean: float = Gain(1.5, "Angle of the centre of mass to straight down, in the middle of a turn [rad]")
    ready: Positive = Gain(0.02, "Error of the wrist's angle at which the box may slip [rad]")
    astray: Positive = Gain(0.006, "Distance of the pads from their goal from which a turn is given up [m]")
    hold_margin: Positive = Gain(1.4, "Grip while holding, over the largest need [-]")
    wrist_rate: Positive = Gain(2.0, "Largest pitch rate of the wrist [rad/s]")
    wrist_acceleration: Positive = Gain(12.0, "Its largest change; the held box has to follow [rad/s^2]")


P = TypeVar("P", bound=PlanGains)


class PlanarPlanPolicy(GainPolicy[P], Generic[P]):
    """Slide, turn, slide the rest, turn the rest; in between hold firmly and point gravity with the wrist.

    All is planned on the box: b, the pads' place on it, has to go to the place that the target gives them,
    along the upward direction. The box slides without turning while its centre of mass hangs under the
    pads, at any pitch of the wrist; with its centre of mass to the side it turns, and the pads creep
    r^2 / |b| per radian along the arc (docs/environments/planar_slip.md). So the first slide goes to where
    that creep will begin, a little short; the turn follows with the centre of mass about level with the
    pads; then the box hangs again and slides the rest. Every stage uses the measured slip, so that
    each one corrects what the one before has left over. A turn in which the pads go astray is given up:
    the box would slide on until it falls. Subclasses say how the object slips.
    """

    task = "PlanarSlip"
    action_mode = "grip_force_pitch"
    prior_default = ConservativePrior(r=0.004)
    Slips: ClassVar[type]
    """Named tuple of the subclass's own memory."""

    @abstractmethod
    def slip(
        self, columns: Columns, slips: Any, motion: Motion, begins: np.ndarray, r: np.ndarray
    ) -> tuple[np.ndarray, Any]:
        """Kind of slip of the object.

        Args:
            columns: n observations.
            slips: The subclass's own memory.
            motion: What the plan asks for.
            begins: Whether a slip begins, (n,).
            r: Contact radius (n,) [m].

        Returns:
            Grip per finger (n,) [N], and the new memory.
        """

    @abstractmethod
    def creep(self, left: np.ndarray, r: np.ndarray) -> np.ndarray:
        """Creep along the arc of a turn that is left [rad], times |b|, (n,) [m^2]."""

    def interruptible(self, slips: Any) -> np.ndarray | bool:
        """Rows in which a slip may begin or end now, (n,) or all."""
        return True

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger and wrist velocity, (n, 4) [N, m/s, m/s, rad/s]."""
        width = len(PlanState._fields)
        memory = np.asarray(state).T
        past, slips = followed(columns, PlanState(*memory[:width])), self.Slips(*memory[width:])
        r = self.prior.blend(columns, "r")
        turning, slips_on = (past.stage == TURN) | (past.stage == TRIM), past.slipping > 0.0
        left = columns["target_theta"] - columns["measured_slip_theta"]
        side = np.where(slips_on, past.side, np.sign(left))
        attitude = columns["wrist_pitch"] + columns["measured_slip_theta"]
        place = turned((-past.x, -past.y), -columns["measured_slip_theta"])
        under = np.arctan2(*place)  # attitude in which the box hangs
        way = self._way(columns, place, past.stage, self.creep(left, r))
        # how far to go, and the attitude in which to go there
        along = np.where(past.stage == FINISH, under, attitude)
        distance = np.where(turning, side * left, way[0] * np.sin(along) + way[1] * np.cos(along))
        near = np.hypot(*way) < 2.0 * self.gains.short
        steer = np.where(near, attitude, np.arctan2(*way))
        wanted = np.where(past.stage == APPROACH, steer, under)
        wanted = np.where(turning, under - side * (self.gains.lean + 0.5 * np.abs(left)), wanted)
        fixed = (past.stage == DONE) | (slips_on & (past.stage != APPROACH))
        off = np.where(fixed, 0.0, wrapped(wanted - attitude))
        speed = np.where(turning, side * both(columns, "omega"), _falling(columns))
        aligned = (np.abs(off) < self.gains.ready) & (np.abs(columns["wrist_pitch_rate"]) < 0.1)
        free = self.interruptible(slips)
        unfinished = past.stage < DONE
        least = np.where(turning, self.gains.least[1], self.gains.least[0])
        arrived = free & (distance <= np.where(slips_on, 0.5, 1.0) * least)
        rests = np.abs(speed) < np.where(turning, _REST[1], _REST[0])
        stage = np.where(~slips_on & arrived & rests & unfinished, past.stage + 1, past.stage)
        lost = free & turning & (np.hypot(*way) > self.gains.astray)  # it slides more than it turns
        stage = np.where(lost, DONE, stage)
        slipping = ~arrived & (slips_on | (free & aligned & unfinished)) & ~lost
        lever = np.hypot(*place) + self.gains.short
        need = np.hypot(1.0, lever / self.prior.hold(columns, "r")) / self.prior.hold(columns, "mu_c")
        held = self.gains.hold_margin * past.weight * need
        motion = Motion(turning, distance, speed, slipping, held)
        force, slips = self.slip(columns, slips, motion, slipping & (past.slipping == 0.0), r)
        rate, still = self._pitch(off, columns["wrist_pitch_rate"]), np.zeros(len(columns))
        past = past._replace(stage=stage, slipping=slipping, side=side)
        return np.column_stack((force, still, still, rate)), np.column_stack((*past, *slips))

    def _way(self, columns: Columns, place: Point, stage: np.ndarray, creep: np.ndarray) -> Point:
        """From the pads' place to the next goal, on the box [m]; creep over |b| is the coming arc [m^2]."""
        goal = turned((-columns["target_x"], -columns["target_y"]), -columns["target_theta"])
        reach, bearing = np.hypot(*goal), np.arctan2(*goal)
        short = np.where(stage == APPROACH, self.gains.short, 0.0)
        arc = np.where(stage == APPROACH, creep / np.maximum(reach, self.gains.short), 0.0)
        sin, cos = np.sin(bearing), np.cos(bearing)
        return goal[0] - short * sin + arc * cos - place[0], goal[1] - short * cos - arc * sin - place[1]

    def _pitch(self, off: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Pitch rate that turns the wrist by `off` and then rests [rad/s]."""
        braking = np.minimum(np.sqrt(1.4 * self.gains.wrist_acceleration * np.abs(off)), 8.0 * np.abs(off))
        change = np.sign(off) * np.minimum(braking, self.gains.wrist_rate) - rate
        most = self.gains.wrist_acceleration * self._dt
        return rate + np.clip(change, -most, most)


def turned(point: Point, angle: np.ndarray) -> Point:
    """A point turned about the origin by an angle [rad]."""
    cos, sin = np.cos(angle), np.sin(angle)
    return cos * point[0] - sin * point[1], sin * point[0] + cos * point[1]


def wrapped(angle: np.ndarray) -> np.ndarray:
    """An angle between -pi and pi [rad]."""
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def _falling(columns: Columns) -> np.ndarray:
    """Slip velocity along gravity [m/s]."""
    pitch = columns["wrist_pitch"]
    return -np.sin(pitch) * both(columns, "v_x") - np.cos(pitch) * both(columns, "v_y")


def followed(columns: Columns, past: PlanState) -> PlanState:
    """The memory with the slip displacement and the weight as they are now.

    Measured slip is the sum of velocities at the pad centre; a turn carries the grasped point along.
    """
    x, y, theta = (columns[f"measured_slip_{axis}"] for axis in ("x", "y", "theta"))
    dx, dy, turn = x - past.measured_slip_x, y - past.measured_slip_y, theta - past.measured_slip_theta
    load = tangential(columns)
    return past._replace(
        x=past.x + dx - turn * (past.y + 0.5 * dy),
        y=past.y + dy + turn * (past.x + 0.5 * dx),
        measured_slip_x=x,
        measured_slip_y=y,
        measured_slip_theta=theta,
        weight=np.where(past.weight == 0.0, load, 0.98 * past.weight + 0.02 * load),
    )
