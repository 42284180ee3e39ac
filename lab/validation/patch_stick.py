"""Checks the stick and the energy of the distributed contact under prescribed loads and twists."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from lab.limit_surface_exact import FRICTION
from lab.validation.patch_surface import MU_C, MU_S, NORMAL, RADIUS, ROUNDING
from slipgym.contact import DistributedContact
from slipgym.validation.bench import Figure

SIGMA_0, SIGMA_1, SIGMA_2 = 1e6, 80.0, 0.2
CREEP_BOUND = 1e-3  # [mm]
HOLD = 60.0  # [s]
HOLD_STEP = 1e-3  # [s]
LOOP_LEVEL = 0.6
LOADS = {
    "along x": (1.0, 0.0, 0.0),
    "torque": (0.0, 0.0, 1.0),
    "force and torque": (0.5, -0.4, 0.77),
}


def hold(direction: tuple[float, float, float], level: float) -> float:
    """Creep of a massless object on a damper under a load that oscillates by 5 % at 10 Hz.

    The object has no inertia: its twist is proportional to the difference of load and friction, so it
    depends on the contact alone.

    Args:
        direction: Of the scaled load (f_x, f_y, tau / r).
        level: Size of the load over mu_c f_n.

    Returns:
        Largest distance of the scaled pose from that after 1 s, at whole periods, over 60 s [m].
    """
    contact = DistributedContact(RADIUS, mu_c=MU_C, mu_s=MU_S)
    r = contact.effective_radius
    load = level * MU_C * NORMAL * np.array(direction) / np.linalg.norm(direction)
    # a third of the way to balance per step; less than 1, so that it does not overshoot
    mobility = 1.0 / (3.0 * NORMAL * (SIGMA_0 * HOLD_STEP + SIGMA_1 + SIGMA_2))
    pose, friction, start, away = np.zeros(3), np.zeros(3), np.zeros(3), 0.0
    for k in range(round(HOLD / HOLD_STEP)):
        ramp = min(1.0, k * HOLD_STEP / 0.2)
        tremble = 1.0 + 0.05 * math.sin(20.0 * math.pi * k * HOLD_STEP)
        twist = mobility * (ramp * tremble * load + friction)
        f_x, f_y, tau = contact.step((twist[0], twist[1], twist[2] / r), NORMAL, HOLD_STEP)
        friction[:] = f_x, f_y, tau / r
        pose += HOLD_STEP * twist
        if k % 100 == 0 and k >= 1000:
            start = pose.copy() if k == 1000 else start
            away = max(away, float(np.linalg.norm(pose - start)))
    return away


def energy_gain(seed: int, pressure: str, steps: int = 400) -> float:
    """Largest energy that friction gives beyond its store, in a step of a random motion.

    Twists change at random in size (1e-7 to 1 m/s), direction and duration (1e-6 to 1e-2 s), so that cells
    stick, slip, turn and stick again; the normal force is constant.

    Returns:
        Largest rise of the stored energy beyond the work done against friction, over the largest store.
    """
    rng = np.random.default_rng(seed)
    contact = DistributedContact(
        RADIUS, 7, pressure, MU_C, MU_S, sigma_1=rng.choice([0.0, SIGMA_1]), sigma_2=0.0
    )
    r, shares = contact.effective_radius, contact.shares
    limit = 0.5 * NORMAL * MU_S**2 / SIGMA_0
    store, gain = 0.0, -math.inf
    direction = rng.normal(size=3)
    for _ in range(steps):
        if rng.random() < 0.3:
            direction = rng.normal(size=3)
        twist = 10.0 ** rng.uniform(-7.0, 0.0) * direction / (1.0, 1.0, r)
        dt = 10.0 ** rng.uniform(-6.0, -2.0)
        wrench = contact.step(twist.tolist(), NORMAL, dt)
        work = -dt * float(np.dot(wrench, twist))
        after = 0.5 * NORMAL * SIGMA_0 * float(shares @ (contact.bristles**2).sum(axis=1))
        gain, store = max(gain, (after - store - work) / limit), after
    return gain


def loop_residue(direction: tuple[float, float, float]) -> float:
    """Change of friction by closed loops of elastic motion about a load, over mu_c f_n.

    Args:
        direction: Of the scaled displacement.

    Returns:
        Size of the change of scaled friction after 20 loops [-].
    """
    contact = DistributedContact(RADIUS, mu_c=MU_C, mu_s=MU_S, sigma_1=0.0, sigma_2=0.0)
    r = contact.effective_radius
    towards = np.array(direction) / np.linalg.norm(direction) / (1.0, 1.0, r)
    reach = LOOP_LEVEL * MU_C / SIGMA_0  # at the edge 1.8 times as much, just below mu_s, is still elastic
    for _ in range(100):
        start = contact.step((10.0 * reach * towards).tolist(), NORMAL, 1e-3)
    phase = 2.0 * math.pi * (np.arange(100) + 0.5) / 100
    loop = 2e-6 * np.stack([np.cos(phase), np.sin(phase), np.cos(phase) / r], axis=1)
    for _ in range(20):
        for twist in loop.tolist():
            end = contact.step(twist, NORMAL, 1e-3)
    change = (np.array(end) - start) / (1.0, 1.0, r)
    return float(np.linalg.norm(change)) / (MU_C * NORMAL)


def patch_stick() -> Iterator[Figure]:
    """Creep, closed loops, energy."""
    for name, direction in LOADS.items():
        yield Figure(
            f"patch: creep in {HOLD:.0f} s at 80 %, {name}", CREEP_BOUND, 1e3 * hold(direction, 0.8), "mm"
        )
        residue = 100.0 * loop_residue(direction)
        yield Figure(f"patch: friction after elastic loops, {name}", ROUNDING, residue, "%")
    for name in FRICTION:
        gain = max(energy_gain(seed, name) for seed in range(20))
        yield Figure(f"patch, {name}: energy gained, 20 random motions", 1e-12, gain, "store")
