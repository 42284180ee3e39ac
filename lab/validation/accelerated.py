"""Checks stick under an accelerating wrist: its limit, its friction and its drift."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from slipgym.validation.bench import Bench, Figure, Friction
from slipgym.validation.breakaway import BROKEN, broken_away

BOUND = 1.0  # [%]
RATE = 0.4  # of the limit [1/s]: within a control step the load grows by 0.33 %
FORCE = 1.0  # grip per finger [N]
FRICTION = Friction(mu_s=0.5, mu_c=0.4)
MASS = 0.2  # [kg]
SCALE = 1.0, 1.0, FRICTION.r  # of a motion (x, z, pitch)
DIRECTIONS = {
    "+x": (1.0, 0.0, 0.0),
    "-x": (-1.0, 0.0, 0.0),
    "+z": (0.0, 1.0, 0.0),
    "-z": (0.0, -1.0, 0.0),
    "oblique": (0.6, -0.8, 0.0),
    "pitch": (0.0, 0.0, 1.0),
}
"""Acceleration (x, z, pitch) of the wrist that uses up the scaled friction limit."""
ENGINE_STEPS = 2, 4, 5, 8, 10, 20
SHAKEN = 0.9  # of the friction limit
FREQUENCY = 2.0  # of the shaken wrist [Hz]
SHAKE_TIME = 60.0  # [s]
DRIFT_BOUND = 1e-3  # [mm]


def bench(engine_steps: int, gyration: float, **options: Any) -> Bench:
    """A box in a light grip, without gravity, on a wrist without speed limits.

    Args:
        engine_steps: Engine steps per control step.
        gyration: Radius of gyration of the box over r [-]. The larger, the slower the wrist must turn; the
            smaller, the faster the box follows its bristles.
        **options: More arguments of `Bench`.
    """
    overrides = {
        "physics": {"gravity": 0.0, "engine_steps": engine_steps},
        "gripper": {"wrist_speed_max": 1e3, "wrist_pitch_rate_max": 1e3},
    }
    inertia = MASS * (gyration * FRICTION.r) ** 2
    return Bench(overrides, friction=FRICTION, force=FORCE, mass=MASS, inertia=inertia, **options)


def limits(held: Bench) -> np.ndarray:
    """Acceleration (x, z, pitch) of the wrist that reaches the static limit by itself [m/s^2, rad/s^2]."""
    force = held.limit()
    linear, pitch = force / held.box.mass, force * held.friction.r / held.box.inertia
    return np.array([linear, linear, pitch])


def break_away(direction: tuple[float, float, float], engine_steps: int = 4, **options: Any) -> float:
    """Load at break-away over the static limit, the wrist's acceleration rising evenly [-].

    The pitching wrist breaks the contact away before its speed matters: the centre of mass is the pad centre.

    Args:
        direction: Acceleration (x, z, pitch), each over its limit.
        engine_steps: Engine steps per control step.
        **options: More arguments of `Bench`.
    """
    with bench(engine_steps, 3.0, **options) as held:
        most = limits(held) * np.array(direction)
        half = 0.5 * held.step_time
        # the velocity at the end of the step that starts at t - step_time; the acceleration is constant in a
        # step and that of the ramp in its middle
        trace = held.run(3.0 / RATE, wrist=lambda t: most * 0.5 * RATE * t * t, until=broken_away)
        # on the limit the excess of the load moves the object, of a mass that it has in scaled displacement,
        # by RATE * limit * t^3 / (6 mass) until it counts as broken away
        mass = held.limit() / float(np.linalg.norm(most * SCALE))
        reach = held.friction.mu_s / held.config.contact.sigma_0
        late = (6.0 * mass * (BROKEN - reach) / (RATE * held.limit())) ** (1.0 / 3.0)
        return float(RATE * (trace.time[-1] - half - late))


def shake(
    direction: tuple[float, float, float], duration: float, engine_steps: int = 4, **options: Any
) -> tuple[float, float]:
    """A wrist shaken at 90 % of the limit.

    Args:
        direction: As of `break_away`.
        duration: [s].
        engine_steps: Engine steps per control step.
        **options: More arguments of `Bench`.

    Returns:
        Largest scaled slip displacement after the first period, less that at its end [mm], and largest
        difference between the friction at the ends of control steps and the load, over the limit [-].
    """
    with bench(engine_steps, 1.0, **options) as held:
        omega = 2.0 * math.pi * FREQUENCY
        peak = SHAKEN * limits(held) * np.array(direction)
        step, wrong = held.step_time, 0.0

        def wrist(t: float) -> np.ndarray:
            return peak / omega * math.sin(omega * t)

        slips = []
        mass = np.array([MASS, MASS, MASS * FRICTION.r**2])
        for i in range(round(duration / step)):
            now, then = wrist(i * step), wrist((i + 1) * step)
            held.run(step, wrist=lambda _, then=then: then)
            pitch = float(held.plant.world["wrist"][0, 2])
            acceleration = (then - now) / step
            force = mass * acceleration
            cos, sin = math.cos(pitch), math.sin(pitch)
            needed = np.array([cos * force[0] + sin * force[1], cos * force[1] - sin * force[0], force[2]])
            found = held.plant.pads["wrench"][0].sum(axis=0)
            wrong = max(wrong, float(np.linalg.norm((found - needed) / SCALE)) / held.limit())
            slips.append(held.plant.world["slip"][0] * SCALE)
        rate = round(1.0 / (FREQUENCY * step))
        moved = np.array(slips[rate - 1 :: rate])
        return 1e3 * float(np.linalg.norm(moved - moved[0], axis=1).max()), wrong


def accelerated() -> Iterator[Figure]:
    """Break-away and friction under an accelerating wrist, for several numbers of engine steps."""
    for engine, wrist in (("bullet", "wrist"), ("planar", "planar: wrist")):
        for name, direction in DIRECTIONS.items():
            loads = [break_away(direction, steps, engine=engine) for steps in ENGINE_STEPS]
            worst = max(abs(load - 1.0) for load in loads)
            yield Figure(f"{wrist} accelerating, {name}, break-away", BOUND, 100.0 * worst, "%")
        for name in ("+x", "oblique", "pitch"):
            moved, wrong = shake(DIRECTIONS[name], SHAKE_TIME, engine=engine)
            yield Figure(f"{wrist} shaken at 90 %, {name}, creep", DRIFT_BOUND, moved, "mm")
            yield Figure(f"{wrist} shaken at 90 %, {name}, friction", BOUND, 100.0 * wrong, "%")
