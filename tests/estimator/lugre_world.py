"""A simulation of one finger that shares no code with slipgym: distributed LuGre friction in small steps.

The friction is that of arXiv 2308.01123 (a bristle in each cell of the patch), the object a rigid body in the
contact plane, the sensors noise, counts and delays. `stick_slip` drags it by a spring; `planar` moves it by a
stiff velocity drive whose direction and share of spin wander.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

RATE, FORCE_RATE, STEP = 120, 1000, 2e-5  # [1/s], [1/s], [s]
GRASP, MOTION = 0.5, 0.9  # the gripper closes, the object is driven [s]
SIGMA_0, SIGMA_1, SIGMA_2, STRIBECK = 2e5, 40.0, 0.2, 1e-3  # [1/m], [s/m], [s/m], [m/s]
MASS, INERTIA = 0.2, 3e-4  # [kg], [kg m²]
COUNT, CHIPS = 7.94e-6, 0.0243  # of the optical sensors: a count and their distance from the centre [m]
NOISE = 0.02, 0.02, 0.04, 5e-4  # of f_x, f_y, f_n, tau [N, N, N, N m]


class Trace(NamedTuple):
    """What happened, at `FORCE_RATE`, and the truth."""

    time: np.ndarray
    wrench: np.ndarray
    """f_x, f_y, f_n, tau of the pad on the object, (n, 4)."""
    pose: np.ndarray
    """Displacement x, y, theta of the object on the pad, (n, 3)."""
    mu_c: float
    r: float


def patch(kind: str, radius: float = 0.012, n: int = 11) -> tuple[np.ndarray, np.ndarray, float]:
    """Cells (m, 2) and load shares (m,) of a round patch, "disc" or "hertz", and its equivalent radius."""
    size, inner = 2 * radius / n, np.linspace(-4, 4, 9) / 9
    x, y = np.meshgrid(*[(np.arange(n) - (n - 1) / 2) * size] * 2)
    share = np.mean([np.hypot(x + a * size, y + b * size) <= radius for a in inner for b in inner], axis=0)
    if kind == "hertz":
        share = share * np.sqrt(np.maximum(1 - (x**2 + y**2) / radius**2, 0.01))
    loaded = share > 0
    cells, share = np.stack([x[loaded], y[loaded]], axis=1), share[loaded] / share[loaded].sum()
    return cells, share, float(share @ np.hypot(*cells.T))


def stick_slip(mu_c, mu_s, force=4.0, speed=8e-3, stiffness=300.0, spin=0.2, kind="disc", time=6.0) -> Trace:
    """A spring pulls the object: it sticks and slips."""
    drive = (0.0, speed, spin, stiffness, 0.0)
    return _run(patch(kind), mu_c, mu_s, (force, force), drive, (math.inf, 1.0), time)


def planar(
    mu_c,
    mu_s,
    forces=(5.0, 9.0),
    speed=0.02,
    spin=1.5,
    turn=0.0,
    kind="disc",
    jump=(math.inf, 1.0),
    time=6.0,
    radius=0.012,
) -> Trace:
    """The object slides and spins; friction is multiplied by jump[1] at the time jump[0]."""
    return _run(patch(kind, radius), mu_c, mu_s, forces, (1.0, speed, spin, 0.0, turn), jump, time)


def _run(support, mu_c, mu_s, forces, drive, jump, time) -> Trace:
    cells, share, r = support
    out = np.zeros((int(time * FORCE_RATE), 8))
    _integrate(out, cells, share, mu_c, mu_s, np.array(forces), np.array(drive), np.array(jump))
    return Trace(out[:, 0], out[:, 1:5], out[:, 5:], mu_c, r)


@njit(cache=True)
def _integrate(out, cells, share, mu_c, mu_s, forces, drive, jump):
    planar, speed, spin, stiffness, turn = drive
    z, pose, v = np.zeros((len(share), 2)), np.zeros(3), np.zeros(3)
    every = round(1 / (FORCE_RATE * STEP))
    for i in range(len(out) * every):
        t = i * STEP
        grip = min(max((t - GRASP) / 0.1, 0.0), 1.0)
        f_n = grip * (forces[0] + (forces[1] - forces[0]) * 0.5 * (1 - math.cos(2 * math.pi * t / 3)))
        factor = 1.0 if t < jump[0] else jump[1]
        load = np.zeros(3)
        for c in range(len(share)):
            x, y = cells[c]
            u_x, u_y = v[0] - v[2] * y, v[1] + v[2] * x
            u = math.hypot(u_x, u_y)
            g = factor * (mu_c + (mu_s - mu_c) * math.exp(-((u / STRIBECK) ** 2)))
            bent, limit = math.hypot(z[c, 0], z[c, 1]), g / SIGMA_0
            yields = 0.0  # elasto-plastic: bristles that are not bent far do not creep
            if u_x * z[c, 0] + u_y * z[c, 1] > 0 and bent > 0.9 * limit:
                yields = 0.5 - 0.5 * math.cos(math.pi * min((bent / limit - 0.9) / 0.1, 1.0))
            rate = yields * SIGMA_0 * u / g
            z_x, z_y = (z[c, 0] + STEP * u_x) / (1 + STEP * rate), (z[c, 1] + STEP * u_y) / (1 + STEP * rate)
            f_x = -share[c] * f_n * (SIGMA_0 * z_x + SIGMA_1 * (z_x - z[c, 0]) / STEP + SIGMA_2 * u_x)
            f_y = -share[c] * f_n * (SIGMA_0 * z_y + SIGMA_1 * (z_y - z[c, 1]) / STEP + SIGMA_2 * u_y)
            z[c, 0], z[c, 1] = z_x, z_y
            load += np.array([f_x, f_y, x * f_y - y * f_x])
        moving, started = max(t - MOTION, 0.0), 1.0 if t > MOTION else 0.0
        inertia = np.array([MASS, MASS, INERTIA])
        if planar:
            begin, angle = min(moving / 0.3, 1.0), 0.6 * math.sin(0.9 * t + turn) + 0.5 * t
            along = begin * speed * (0.6 + 0.4 * math.sin(2.1 * t))
            wanted = np.array(
                [
                    along * math.cos(angle),
                    along * math.sin(angle),
                    begin * spin * (1 + 0.5 * math.sin(1.7 * t)),
                ]
            )
            force = 200 * inertia * (wanted - v)  # and what friction takes: a stiff drive
        else:
            wanted = np.array([speed, 0.0, spin])
            springs = stiffness * np.array([1.0, 1.0, 1e-4])
            dampers = np.array([2.0, 2.0, 2e-3])
            force = springs * (wanted * moving - pose) + dampers * (started * wanted - v) + load
        v = v + STEP * force / inertia if f_n > 0 else np.zeros(3)
        pose = pose + STEP * v
        if i % every == 0:
            row = out[i // every]
            row[0], row[1:3], row[3], row[4], row[5:] = t, load[:2], f_n, load[2], pose


def sense(
    trace, rng, late=0, jitter=0.0, zero=(0.0, 0.0), tilt=0.0, cop=(0.0, 0.0), scale=0.0, force_late=0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (m,), wrenches (m, 4) and twists (m, 3) at `RATE`, as sensors read them.

    Args:
        trace: A trace.
        rng: Source of the noise.
        late: Samples by which the velocity is later than the usual one.
        jitter: Share of velocities that are another sample late.
        zero: Zero errors of f_x and f_y [N].
        tilt: Of the force sensor about y [rad].
        cop: Error of the assumed centre of pressure [m].
        scale: Relative error of the velocity.
        force_late: Delay of the force [ms].
    """
    wrench = trace.wrench.copy()
    wrench[:, 0] += math.sin(tilt) * wrench[:, 2]
    wrench[:, :2] += zero
    wrench[:, 3] -= cop[0] * wrench[:, 1] - cop[1] * wrench[:, 0]
    wrench += rng.normal(size=wrench.shape) * NOISE
    times = np.arange(int(trace.time[-1] * RATE)) / RATE
    at = np.rint(times * FORCE_RATE).astype(int)
    angles = np.radians([90, 210, 330])
    chips = CHIPS * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    x, y, theta = trace.pose[at].T[..., np.newaxis]
    ways = np.stack([x - theta * chips[:, 1], y + theta * chips[:, 0]], axis=2)
    counts = np.floor(ways / COUNT + rng.uniform(size=(3, 2)))
    speeds = np.diff(counts, axis=0, prepend=counts[:1]) * COUNT * RATE * (1 + scale)
    axes = np.array([row for p in chips for row in ([1, 0, -p[1]], [0, 1, p[0]])])
    twists = np.linalg.lstsq(axes, speeds.reshape(len(times), 6).T, rcond=None)[0].T
    twists[:, 0] -= twists[:, 2] * cop[1]
    twists[:, 1] += twists[:, 2] * cop[0]
    shown = np.arange(len(times)) - 1 - late - (rng.uniform(size=len(times)) < jitter)
    twists = np.where((shown >= 0)[:, np.newaxis], twists[np.maximum(shown, 0)], 0.0)
    return times, wrench[np.maximum(at - force_late, 0)], twists
