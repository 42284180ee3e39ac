"""The scenes of the suite, the same for every engine: each takes a `Variant` and returns what it measured."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lab.suite import truth
from lab.suite.rig import SETTLE_TIME, Grasp, R, Rig, Variant
from slipgym.validation.energy import largest_rise

GRAVITY = 9.81
"""[m/s^2]"""
REST = np.zeros(2)
HOLD_LEVEL = 0.8
"""Load of the hold over the friction limit [-]."""
HOLD_TIME = 60.0
"""How long a weight is held [s]."""
BOTH_TIME = 10.0
"""How long a force and a torque are held together [s]."""
LOST = 100.0
"""Slip at which a hold ends, since the pads come near the edge of the object [mm]."""
RAMP_START, RAMP_RATE, RAMP_END = 0.9, 0.02, 1.5
"""Load of the ramp over the friction limit: from, rate [1/s], to."""
BROKEN = 1e-3
"""Scaled slip speed that counts as broken away [m/s]."""
SLIP_WINDOW = 0.02
"""Time over which that speed is measured [s]."""
GAMMAS = 1.0, 0.9, 0.7, 0.5, 0.3, 0.0
"""Of the scaled slip twists in steady slip, v_t / v [-]."""
AZIMUTH = 0.6
"""Direction of sliding in the contact plane [rad]."""
SLIDING = Grasp(mass=5.0, inertia=5.0 * R * R)
"""Heavy, so that slip stays nearly steady; mass m and inertia m r^2 keep the scaled twist's direction."""
SPEED = 0.1
"""Scaled slip speed at the start of sliding [m/s]."""
SLIDE_WINDOW = 0.005, 0.045
"""Time since the throw over which friction is averaged [s]."""
THROWS = (0.3, 0.0, 0.0), (0.0, 0.0, 0.3), (0.2, 0.1, 0.2), (-0.1, 0.2, -0.3)
"""Scaled velocities (v_x, v_z, r omega) from which energy is watched [m/s]."""
SHAKE_TIME = 5.0
"""[s]"""
SHAKE_LEVEL = 0.9
"""Largest load of the shaken wrist over the friction limit [-]."""
SHAKE = np.array([4.0, 6.0])
"""Amplitude of the wrist's acceleration along x and z [m/s^2]."""
SHAKE_RATE = 2.0 * math.pi * np.array([2.0, 3.0])
"""[rad/s]"""


def grasped_point(rig: Rig) -> np.ndarray:
    """Where the object's point that was at the pad centre is now, from the pad centre: slip, (3,)."""
    x, z, angle = rig.position
    return np.array([x - rig.wrist[0], z - rig.wrist[1], angle])


def run(
    rig: Rig,
    duration: float,
    load: Callable[[float], np.ndarray],
    wrist: Callable[[float], np.ndarray] | None = None,
) -> np.ndarray:
    """Run for a time and return the slip after every step, (n, 3) [m, m, rad].

    Args:
        rig: Grasp.
        duration: [s].
        load: Of the time since the start [s]: force, and torque about the pad centre (3,).
        wrist: Velocity (2,) of the time [m/s]; at rest by default.
    """
    rows = []
    for i in range(round(duration / rig.step_time)):
        t = i * rig.step_time
        f_x, f_z, torque = load(t)
        x, z, _ = grasped_point(rig)  # the force acts on the centre of mass
        lever = np.array([f_x, f_z, torque - x * f_z + z * f_x])
        rig.step(lever, REST if wrist is None else wrist(t + rig.step_time))
        rows.append(grasped_point(rig))
    return np.array(rows)


def settled(variant: Variant, grasp: Grasp) -> Rig:
    """A rig whose pads rest on the object."""
    rig = variant.make(grasp)
    run(rig, SETTLE_TIME, lambda _: np.zeros(3))
    return rig


def scaled(direction: np.ndarray) -> np.ndarray:
    """A scaled load (f_x, f_z, tau / r) as a load."""
    return direction * (1.0, 1.0, R)


def along(gamma: float) -> np.ndarray:
    """Scaled slip twist of speed 1 m/s at a gamma_t, (3,)."""
    spin = math.sqrt(1.0 - gamma * gamma)
    return np.array([gamma * math.cos(AZIMUTH), gamma * math.sin(AZIMUTH), spin])


def limit_load(gamma: float) -> np.ndarray:
    """Scaled load at the exact limit against which the pads slip at a gamma_t, over mu sum f_n, (3,)."""
    return -truth.friction(along(gamma))


@dataclass(frozen=True)
class Held:
    """What a hold measured."""

    distance: float
    """Largest distance from where the object was one second after the load began [mm]."""
    angle: float
    """The same, angle [deg]."""
    duration: float
    """How long the object was held [s]."""
    cost: float
    """Processor time per simulated second [-]."""

    @property
    def lost(self) -> bool:
        """Whether the object crept out of the pads' reach."""
        return self.distance >= LOST


def hold(variant: Variant, gamma: float, duration: float) -> Held:
    """Hold an object at 80 % of the limit.

    Args:
        variant: Engine.
        gamma: Direction of the load, as `limit_load`. At 1 the load is the object's weight.
        duration: How long to hold it, if it is not lost before [s].
    """
    weight = Grasp().mass * GRAVITY
    grasp = Grasp(force=weight / (HOLD_LEVEL * Grasp(force=1.0).limit))
    load = weight * scaled(limit_load(gamma))
    rig = settled(variant, grasp)
    run(rig, 0.5, lambda t: 2.0 * t * load)
    start = run(rig, 0.5, lambda _: load)[-1]
    distance = angle = held = cost = 0.0
    while held < duration and distance < LOST:
        began = time.process_time()
        slip = np.abs(run(rig, 1.0, lambda _: load) - start)
        cost += time.process_time() - began
        held += 1.0
        distance = max(distance, 1e3 * np.hypot(slip[:, 0], slip[:, 1]).max())
        angle = max(angle, math.degrees(slip[:, 2].max()))
    rig.close()
    return Held(distance, angle, held, cost / held)


def ramp(variant: Variant, gamma: float) -> float:
    """Load at break-away over the exact limit, less 1, in percent; infinite if it never breaks away."""
    grasp = Grasp()
    load = grasp.limit * scaled(limit_load(gamma))
    rig = settled(variant, grasp)
    run(rig, 0.5, lambda t: RAMP_START * t / 0.5 * load)
    before = grasped_point(rig)
    level = RAMP_START
    while level < RAMP_END:
        start = level
        slip = run(rig, SLIP_WINDOW, lambda t, start=start: (start + RAMP_RATE * t) * load)[-1]
        level += RAMP_RATE * SLIP_WINDOW
        if np.linalg.norm((slip - before) * (1.0, 1.0, R)) > BROKEN * SLIP_WINDOW:
            break
        before = slip
    else:
        level = math.inf
    rig.close()
    return 100.0 * (level - 1.0)


def steady(variant: Variant, gamma: float) -> tuple[np.ndarray, np.ndarray]:
    """Friction while the object slides and spins, from the change of its momentum.

    Returns:
        Measured and exact friction (f_x, f_z, tau / r) over mu sum f_n, each (3,) [-].
    """
    grasp = SLIDING
    rig = settled(variant, grasp)
    rig.throw(SPEED * along(gamma) / (1.0, 1.0, R))
    position, velocity, spent = rig.position.copy(), rig.velocity.copy(), 0.0
    measured, exact = [], []
    while spent + rig.step_time < SLIDE_WINDOW[1]:
        rig.step(np.zeros(3), REST)
        spent += rig.step_time
        rate = (rig.velocity - velocity) / rig.step_time
        middle, x, z = 0.5 * (rig.velocity + velocity), *(0.5 * (rig.position + position))[:2]
        position, velocity = rig.position.copy(), rig.velocity.copy()
        # an engine's velocity may be its step's mean: the first difference is over less than a step
        if spent - rig.step_time < SLIDE_WINDOW[0]:
            continue
        force = grasp.mass * rate[:2]
        torque = grasp.inertia * rate[2] + x * force[1] - z * force[0]
        measured.append(np.array([*force, torque / R]) / grasp.limit)
        omega = middle[2]
        exact.append(truth.friction(np.array([middle[0] + omega * z, middle[1] - omega * x, R * omega])))
    rig.close()
    return np.mean(measured, axis=0), np.mean(exact, axis=0)


def energy(variant: Variant) -> float:
    """Largest rise of the kinetic energy of freely sliding objects over the energy at the throw [%]."""
    grasp, rises = Grasp(inertia=Grasp().mass * R * R), []
    weight = 0.5 * np.array([grasp.mass, grasp.mass, grasp.inertia])
    for throw in THROWS:
        rig = settled(variant, grasp)
        rig.throw(np.array(throw) / (1.0, 1.0, R))
        energies = [weight @ rig.velocity**2]
        for _ in range(round(0.5 / rig.step_time)):
            rig.step(np.zeros(3), REST)
            energies.append(weight @ rig.velocity**2)
        rises.append(100.0 * largest_rise(np.array(energies)) / energies[0])
        rig.close()
    return max(rises)


def shake(t: float) -> np.ndarray:
    """Wrist velocity (2,) [m/s], from rest to rest."""
    x = min(max(min(t, SHAKE_TIME - t), 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x) * SHAKE / SHAKE_RATE * np.sin(SHAKE_RATE * t)


def shaken(variant: Variant) -> float:
    """Largest slip of an object whose weight and inertia load the pads to at most 90 % of the limit [mm]."""
    times = np.linspace(0.0, SHAKE_TIME, 10001)
    velocity = np.array([shake(t) for t in times])
    needed = np.gradient(velocity, times, axis=0)
    needed[:, 1] += GRAVITY
    mass = Grasp().mass
    grasp = Grasp(force=mass * float(np.hypot(*needed.T).max()) / (SHAKE_LEVEL * Grasp(force=1.0).limit))
    weight = np.array([0.0, -mass * GRAVITY, 0.0])
    rig = settled(variant, grasp)
    run(rig, 0.5, lambda t: 2.0 * t * weight)
    start = run(rig, 0.5, lambda _: weight)[-1]
    slip = run(rig, SHAKE_TIME, lambda _: weight, shake) - start
    rig.close()
    return 1e3 * float(np.hypot(slip[:, 0], slip[:, 1]).max())


def slide(variant: Variant, grasp: Grasp, velocity: np.ndarray) -> float:
    """Distance that the centre of mass of a thrown object slides until it rests [mm]."""
    rig = settled(variant, grasp)
    start = rig.position.copy()
    rig.throw(velocity)
    for _ in range(round(1.0 / rig.step_time)):
        rig.step(np.zeros(3), REST)
        if np.abs(rig.velocity * (1.0, 1.0, R)).max() < BROKEN:
            break
    away = rig.position - start
    rig.close()
    return 1e3 * math.hypot(away[0], away[1])
