"""Swings the object to an angle in the grip by a stroke of the wrist, and stops it there."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np

from policies.controllers.base import Columns, State
from policies.controllers.gains import Fraction, Gain, GainPolicy
from policies.controllers.sensing import ConservativePrior, both
from slipgym.config import Overrides
from slipgym.config.base import Frozen, NonNegative, Positive

BACK, SWING, BRAKE, HOLD = range(4)
"""Stages: the wrist moves back, it makes the stroke, the grip brakes, the grip holds."""
_MARGIN = 0.1
"""Time before the end at which the wrist should rest [s]."""


class PivotState(NamedTuple):
    """Memory, (n,) each; all 0 at the start."""

    stage: np.ndarray  # one of the stages
    weight: np.ndarray  # mean weight measured while the wrist moves back [N]
    samples: np.ndarray  # control steps of that mean
    acceleration: np.ndarray  # last commanded acceleration of the wrist along the stroke [m/s^2]
    probed: np.ndarray  # control steps since the probe ended; 0 before, infinite without a probe


class Motion(NamedTuple):
    """The object in the direction of its goal, (n,) each.

    Torques about the pads are over m d and so accelerations: one of the wrist, across the object, balances
    them.
    """

    goal: np.ndarray  # angle to turn, > 0 [rad]
    angle: np.ndarray  # angle turned [rad]
    rate: np.ndarray  # its rate [rad/s]
    speed: np.ndarray  # speed of the wrist in the direction of the stroke [m/s]
    per_force: np.ndarray  # torque of Coulomb friction over the grip force, over m d [m/s^2 / N]
    loose: np.ndarray  # the torque of Coulomb friction in the grip of the swing, over m d [m/s^2]


class PivotToGains(Frozen):
    """Gains of `PivotToPolicy`."""

    k: Positive = Gain(11.0, "2 mu_c f_n over the weight while the object swings [-]")
    k_probed: Positive = Gain(13.0, "The same where friction was unknown and a probe has slid the object [-]")
    arrive: NonNegative = Gain(2.0, "Rate at the goal for which the stroke goes [rad/s]")
    brake: Positive = Gain(0.8, "Torque at which braking begins, over the largest of friction [-]")
    still: Positive = Gain(0.2, "Rate below which the object is held [rad/s]")
    hold: Positive = Gain(0.7, "Load while held, over the largest of friction [-]")
    age: NonNegative = Gain(0.012, "Age of the measured slip [s]")
    delay: NonNegative = Gain(0.01, "Time for which braking looks ahead [s]")
    speed: Fraction = Gain(0.995, "Speed of the wrist, over the task's largest [-]")
    guess: Positive = Gain(0.5, "mu_c for which the grip of the probe is [-]")
    probe_turn: Positive = Gain(0.1, "Turn away from the goal that ends the probe [rad]")
    wait: NonNegative = Gain(6.0, "Control steps between probe and stroke, at least [-]")


class PivotToPolicy(GainPolicy[PivotToGains]):
    """Move the wrist back, let the object swing in a stroke, brake it by the grip, and hold.

    The object is a pendulum about the pads, with the effective length l = d + rho^2 / d (rho: radius of
    gyration). The wrist accelerates with a along x, and friction takes `loose`:

        l theta'' = a cos(theta) - g sin(theta) - loose,    loose = k g r / d

    Back: the object is held while the wrist moves against the stroke, so that the stroke can be long enough.
    Swing: in the grip f = k W / (2 mu_c), W the weight, the wrist accelerates as fast as it can until
    the energy suffices,

        l theta'^2 / 2 >= g (cos(theta) - cos(goal)) + loose (goal - theta) + l arrive^2 / 2,

    and so again whenever it does not. Brake: the torque that stops the object at the goal, from the angle
    and the rate that are to come, once it is large enough. Hold: the largest grip, while the wrist
    comes to rest as fast as static friction allows. k is a compromise: the object slides
    r / sqrt(k^2 - 1) per radian of a slow turn, and the swing has to overcome k r / d.

    Without full confidence in friction the grip stays loose when the wrist begins to move back. The object
    turns a little away from its goal, from which an estimator learns, and is then held.

    Arguments are those of `GainPolicy`; depth and inertia are those of the object in `config`.
    """

    task = "PivotTo"
    action_mode = "grip_force_translation"
    prior_default = ConservativePrior(mu_c=0.3, r=0.003, confidence=0.02)
    without_friction: ClassVar[Mapping[str, Any]] = {"prior": ConservativePrior(mu_c=0.55, r=0.003)}
    Gains = PivotToGains

    def _prepare(self, config: Overrides | None) -> None:
        settings: Any = self.settings
        box = settings.object or self.config.object
        self._depth = max(math.dist(box.grasp_offset, box.com_offset), 1e-3)
        self._length = self._depth + box.grip_axis_inertia / box.mass / self._depth
        self._fastest = self.gains.speed * settings.wrist_speed
        self._acceleration = settings.wrist_acceleration

    def initial_state(self, n: int) -> np.ndarray:
        """Columns of `PivotState`, (n, 5)."""
        return np.zeros((n, len(PivotState._fields)))

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger and wrist velocity, (n, 4) [N, m/s, m/s, rad/s]."""
        g, past = self.gains, _weighed(columns, PivotState(*np.asarray(state).T))
        side, largest = np.sign(columns["goal"]), self.config.gripper.force_max
        motion = self._motion(columns, past, side)
        back, probed, ready = self._back(columns, past, motion)
        stage = np.where((past.stage == BACK) & ready, SWING, past.stage)
        now = self._ahead(motion, past.acceleration, columns, g.age)
        stroke = np.where((past.stage <= SWING) & (self._missing(now) > 0.0), self._acceleration, 0.0)
        stroke = np.minimum(stroke, (self._fastest - motion.speed) / self._dt)
        soon = self._ahead(now, stroke, columns, g.delay)
        torque = self._braking(soon)
        stage = np.where((stage == SWING) & (torque > g.brake * largest * motion.per_force), BRAKE, stage)
        stops = (soon.angle >= motion.goal) | ((soon.rate < g.still) & (motion.angle > 0.5 * motion.goal))
        stage = np.where((stage != BACK) & stops, HOLD, stage)
        grip = np.where(stage == BRAKE, np.maximum(torque, motion.loose), motion.loose) / motion.per_force
        probes = (stage == BACK) & (probed == 0.0)
        held = ~probes & ((stage == BACK) | (stage == HOLD))
        grip = np.where(probes, 0.5 * g.k * past.weight / g.guess, np.where(held, largest, grip))
        rest = self._rest(columns, motion)
        wrist = np.where(stage == BACK, back, np.where(stage == HOLD, rest, stroke))
        velocity, still = -side * (motion.speed + wrist * self._dt), np.zeros(len(columns))
        past = past._replace(stage=stage, acceleration=wrist, probed=probed)
        return np.column_stack((grip, velocity, still, still)), np.column_stack(past)

    def _motion(self, columns: Columns, past: PivotState, side: np.ndarray) -> Motion:
        """The object now, as measured."""
        confidence = columns["confidence_r"]
        r = confidence * columns["r"] + (1.0 - confidence) * self.prior.r
        moment = past.weight * self._depth / self.config.physics.gravity
        k = np.where(np.isinf(past.probed), self.gains.k, self.gains.k_probed)
        return Motion(
            goal=np.abs(columns["goal"]),
            angle=side * columns["measured_slip_theta"],
            rate=side * both(columns, "omega"),
            speed=-side * columns["wrist_velocity_x"],
            per_force=2.0 * self.prior.blend_lever(columns) / moment,
            loose=k * r * past.weight / moment,
        )

    def _ahead(self, motion: Motion, wrist: np.ndarray, columns: Columns, time: float) -> Motion:
        """The object after a time, at the measured grip and an acceleration of the wrist."""
        friction = motion.per_force * both(columns, "f_n") * np.sign(motion.rate)
        driven = wrist * np.cos(motion.angle) - self.config.physics.gravity * np.sin(motion.angle)
        rate = np.maximum(motion.rate + (driven - friction) / self._length * time, 0.0)
        rate = np.where(motion.rate > 0.1, rate, motion.rate)
        moved = np.where(motion.rate > 0.1, 0.5 * (motion.rate + rate) * time, 0.0)
        return motion._replace(angle=motion.angle + moved, rate=rate)

    def _missing(self, motion: Motion) -> np.ndarray:
        """Energy that the object lacks to arrive at the goal, over m d, (n,) [m^2/s^2]."""
        gravity, left = self.config.physics.gravity, np.maximum(motion.goal - motion.angle, 0.0)
        lifted = gravity * (np.cos(motion.angle) - np.cos(motion.goal)) + motion.loose * left
        kinetic = self.gains.arrive**2 - motion.rate * np.abs(motion.rate)
        return lifted + 0.5 * self._length * kinetic

    def _braking(self, motion: Motion) -> np.ndarray:
        """Torque of friction that stops the object at the goal, over m d, (n,) [m/s^2]."""
        left = np.maximum(motion.goal - motion.angle, 1e-3)
        weight = self.config.physics.gravity * np.sin(motion.angle)
        return 0.5 * self._length * motion.rate**2 / left - weight

    def _back(
        self, columns: Columns, past: PivotState, motion: Motion
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Acceleration of the wrist while it moves back, `PivotState.probed`, and whether it goes no further.

        The stroke goes from a speed to its opposite. Its length follows from the energy, as if it went at the
        largest acceleration all along.
        """
        g, fastest = self.gains, self._acceleration
        start = motion._replace(angle=np.zeros(len(columns)), rate=np.zeros(len(columns)))
        half = 0.5 * np.arcsin(np.clip(self._missing(start) / fastest, 0.0, 0.95))
        middle = fastest * np.cos(half) - self.config.physics.gravity * np.sin(half)
        gained = np.maximum(0.5 * (fastest + middle) - motion.loose, 1.0) / self._length
        speed = np.minimum(0.5 * fastest * np.sqrt(4.0 * half / gained), self._fastest)
        confidence = columns["confidence_mu_c"]
        ends = (motion.angle < -g.probe_turn) | (confidence > 0.0) | (past.probed > 0.0)
        probed = np.where((past.stage == BACK) & ends, past.probed + 1.0, past.probed)
        probed = np.where((past.samples == 1.0) & (confidence >= self.prior.confidence), np.inf, probed)
        bears = np.clip(g.hold * both(columns, "f_n") * motion.per_force, 1.0, fastest)
        most = np.where(past.probed + probed == 0.0, fastest, bears)
        ready = (motion.speed <= 1e-3 - speed) & (probed > g.wait)
        return np.maximum(-most, (-speed - motion.speed) / self._dt), probed, ready

    def _rest(self, columns: Columns, motion: Motion) -> np.ndarray:
        """Acceleration that brings the wrist to rest while the held object stays, (n,) [m/s^2]."""
        known = columns["mu_s"] * self.prior.confidence_weight(columns, "mu_s")
        more = np.maximum(known / self.prior.blend(columns, "mu_c"), 1.0)
        bears = self.gains.hold * self.config.gripper.force_max * motion.per_force * more
        bears = bears - self.config.physics.gravity * np.sin(motion.angle)
        most = np.clip(bears / np.maximum(np.cos(motion.angle), 0.2), 0.5, self._acceleration)
        needed = np.abs(motion.speed) / np.maximum(columns["time_left"] - _MARGIN, self._dt)
        most = np.where(np.abs(motion.rate) < 0.3, np.maximum(most, needed), 0.0)
        return np.clip(-motion.speed / self._dt, -most, most)


def _weighed(columns: Columns, past: PivotState) -> PivotState:
    """The memory with the mean of the weight, while the wrist moves back."""
    back, weight = past.stage == BACK, 2.0 * np.abs(both(columns, "f_y"))
    samples = past.samples + back
    mean = past.weight + (weight - past.weight) / np.maximum(samples, 1.0)
    return past._replace(weight=np.where(back, mean, past.weight), samples=samples)
