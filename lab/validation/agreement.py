"""Checks that PyBullet and the planar world agree, and that wrist and grip follow their commands."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from lab.validation.halving import stick_slip_grip
from slipgym.validation.bench import Bench, Figure
from slipgym.world.bullet_engine import BulletWorld

# Over one engine step of 1/480 s this reads as 5e-7 m/s, a three-hundredth of the slip sensor's noise
MISMATCH_BOUND = 1e-9  # [m]
# Velocity motors reach the commanded pose within every engine step; the solver's iterations leave a
# residual far below a micrometre, of which none integrates because the goal is a position
WRIST_BOUND = 1e-6  # [m, rad]
GRIP_BOUND = 1e-3  # of the grip
SHAKE = np.array([0.01, 0.01, 0.3])  # amplitudes (x, z, pitch) [m, m, rad]
SHAKE_RATES = 2.0 * math.pi * np.array([1.5, 2.0, 1.0])  # [rad/s]


class WatchedWorld(BulletWorld):
    """Notes how far the engine's pose is from the planar one after every engine step."""

    mismatch = 0.0

    def move(self) -> tuple[Any, ...]:
        """See `BulletWorld.move`."""
        rows = self.rows
        if not getattr(rows.loads, "watched", False):
            rows.loads = self._watched(rows.loads)
        reading = super().move()
        self._note(reading[0])
        return reading

    def _watched(self, loads: Callable[..., Any]) -> Callable[..., Any]:
        """`BulletRows.loads`, called before every engine step, with a look at the pose after the last."""

        def look(pose: tuple[Any, ...], *others: Any) -> Any:
            self._note(pose)
            return loads(pose, *others)

        look.watched = True  # type: ignore[attr-defined]
        return look

    def _note(self, pose: tuple[Any, ...]) -> None:
        world = self._plant.world[0]
        if world["tick"] > 0:
            (x, _, z), _ = pose
            self.mismatch = max(self.mismatch, math.hypot(x - world["com"][0], z - world["com"][1]))


class WatchedBench(Bench):
    """A bench on PyBullet that knows how far the engine's object was from the planar one."""

    bullet = WatchedWorld

    @property
    def mismatch(self) -> float:
        """Largest distance between both after an engine step [m]."""
        assert isinstance(self.world, WatchedWorld)
        return self.world.mismatch


def shake(t: float) -> np.ndarray:
    """Wrist velocity of a smooth motion that starts from rest."""
    return SHAKE * SHAKE_RATES * np.sin(SHAKE_RATES * t)


def agreement() -> Iterator[Figure]:
    """Engine against planar world while slipping; object against pads while shaken."""
    with WatchedBench(force=5.0, com_offset=(0.006, -0.01)) as bench:
        bench.settle()
        bench.run(3.0, force=stick_slip_grip, wrist=shake)
        yield Figure("engine against planar pose, slipping", MISMATCH_BOUND, bench.mismatch, "m")
    with WatchedBench(force=20.0, com_offset=(0.006, -0.01)) as bench:
        start = bench.settle()
        trace = bench.run(10.0, wrist=shake)
        moved = np.abs(trace.slip - start.slip[-1])
        lag = np.abs(trace.wrist - trace.wrist_plan)
        grip = np.abs(trace.normal / trace.force - 1.0).max()
        mismatch, friction = bench.mismatch, bench.friction
        give = friction.mu_s / bench.config.contact.sigma_0
        yield Figure("engine against planar pose, shaken", MISMATCH_BOUND, mismatch, "m")
        # a stuck object moves by no more than the bristles' reach
        distance = 1e3 * np.hypot(*moved[:, :2].T).max()
        yield Figure("held object in a shaken wrist", 1e3 * give, distance, "mm")
        angle = math.degrees(moved[:, 2].max())
        yield Figure("held object in a shaken wrist", math.degrees(give / friction.r), angle, "deg")
        yield Figure("wrist against its command", WRIST_BOUND, lag[:, :2].max(), "m")
        yield Figure("wrist against its command", WRIST_BOUND, lag[:, 2].max(), "rad")
        yield Figure("normal force against grip, shaken", GRIP_BOUND, grip, "1")
