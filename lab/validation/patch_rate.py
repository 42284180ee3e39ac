"""Compares the distributed contact with the published rate form, integrated to tight tolerances.

The LuGre patch of Waltersson & Karayiannidis, arXiv 2308.01123, with the elasto-plastic switch of Dupont,
Hayward, Armstrong & Altpeter, Single state elastoplastic friction models, IEEE TAC 47(5), 2002:

    dz_i/dt = v_i - beta_i sigma_0 |v_i| / g_i z_i

beta_i is 0 below 0.9 g_i / sigma_0, 1 from g_i / sigma_0 on, a half sine between, and is scaled by the
alignment (1 + cos(z_i, v_i)) / 2. In steady slip both are the same. Where they differ: a bristle of the
rate form approaches steady slip with the length g / sigma_0 as its scale, the return mapping arrives there
on the shortest way; and elastic motion lowers the rate form's g, which in the mapping needs slip.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.integrate import solve_ivp
from scipy.sparse import csr_array

from lab.validation.patch_steps import friction
from slipgym.contact import DistributedContact
from slipgym.synthetic import Course
from slipgym.validation.bench import Figure

STEP = 1e-4  # [s]
RADIUS = 0.015  # [m]
CELLS = 6  # along either side; even, so that no cell lies at the centre, where spin would not move it
STEADY_ENDS = 0.2, 0.7, 1.0  # of the pieces of `short_profile` at constant twist [s]
MU_C, MU_S, STRIBECK = 0.4, 0.55, 1e-3
SIGMA_0, SIGMA_1, SIGMA_2 = 1e6, 80.0, 0.2
BREAK_AWAY = 0.9
STEADY_BOUND = 0.1  # [%]
# Five break-aways and reversals of 10 ms each, in which the two differ by some percent, in 1.1 s
WHOLE_BOUND = 1.0  # [%]


def short_profile() -> Course:
    """A linear, a rotational and a planar slip with stops and a reversal, 1.1 s."""
    course = Course.start(mu_c=MU_C, mu_s=MU_S, normal=5.0)
    course = course.to("linear", 0.1, v_x=0.02).to("linear", 0.1).to("linear", 0.2, v_x=-0.02)
    course = course.to("stop", 0.1, v_x=0.0).to("rotational", 0.1, omega=2.0).to("rotational", 0.1)
    course = course.to("planar", 0.2, v_x=0.010, v_y=0.012, omega=1.0)
    return course.to("planar", 0.1).to("stop", 0.1, v_x=0.0, v_y=0.0, omega=0.0)


def rate_form(course: Course, positions: np.ndarray, loads: np.ndarray, step: float) -> np.ndarray:
    """Friction (f_x, f_y, tau) by the rate form at the ends of steps along a course.

    Args:
        course: The course.
        positions: Of the cells, shape (n, 2) [m].
        loads: Fractions of the normal force that the cells carry, shape (n,).
        step: Time between two rows [s].

    Returns:
        Shape (m, 3) [N, N, N m].
    """
    x, y = positions.T

    def motion(t: float, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Velocity and rate of the bristles, both (n, 2)."""
        v_x, v_y, omega = course.at(np.array([t]))[:3, 0]
        velocity = np.column_stack((v_x - omega * y, v_y + omega * x))
        z = z.reshape(-1, 2)
        speed, length = np.hypot(*velocity.T), np.hypot(*z.T)
        level = (MU_C + (MU_S - MU_C) * np.exp(-((speed / STRIBECK) ** 2))) / SIGMA_0
        between = np.clip((length / level - BREAK_AWAY) / (1.0 - BREAK_AWAY), 0.0, 1.0)
        cosine = (z * velocity).sum(axis=1) / np.maximum(speed * length, 1e-300)
        beta = 0.5 * (1.0 - np.cos(np.pi * between)) * 0.5 * (1.0 + cosine)
        return velocity, velocity - (beta * speed / level)[:, None] * z

    own = csr_array(np.kron(np.eye(len(loads)), np.ones((2, 2))))  # a cell's bristle knows no other
    z, rows, done = np.zeros(positions.size), [], 0
    for end in course.times[1:]:  # the course has kinks between its pieces
        count = round(end / step)
        times = step * np.arange(done + 1, count + 1)
        solution = solve_ivp(
            lambda t, z: motion(t, z)[1].ravel(),
            (step * done, times[-1]),
            z,
            "Radau",
            times,
            rtol=1e-6,
            atol=1e-12,
            jac_sparsity=own,
            max_step=0.01,
        )
        for t, state in zip(times, solution.y.T, strict=True):
            velocity, rate = motion(t, state)
            force = loads[:, None] * (SIGMA_0 * state.reshape(-1, 2) + SIGMA_1 * rate + SIGMA_2 * velocity)
            normal = course.at(np.array([t]))[3, 0]
            tau = (x * force[:, 1] - y * force[:, 0]).sum()
            rows.append([-normal * part for part in (*force.sum(axis=0), tau)])
        z, done = solution.y[:, -1], count
    return np.array(rows)


def both(course: Course) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (n,) [s] and scaled friction (n, 3) [N] along a course, by the contact and by the rate form."""
    contact = DistributedContact(
        RADIUS, CELLS, "uniform", MU_C, MU_S, STRIBECK, 2.0, SIGMA_0, SIGMA_1, SIGMA_2
    )
    ours = friction(course, STEP, 1, contact)
    theirs = rate_form(course, contact.positions, contact.shares, STEP)
    times = STEP * np.arange(1, len(ours) + 1)
    return times, ours, theirs / (1.0, 1.0, contact.effective_radius)


def patch_rate() -> Iterator[Figure]:
    """Steady slip, and the whole course with its transients, over the largest friction."""
    times, ours, theirs = both(short_profile())
    away = 100.0 * np.linalg.norm(ours - theirs, axis=1) / np.linalg.norm(theirs, axis=1).max()
    steady = np.any([(times > end - 0.05) & (times <= end) for end in STEADY_ENDS], axis=0)
    yield Figure("patch: steady slip against the rate form", STEADY_BOUND, float(away[steady].max()), "%")
    whole = float(np.sqrt((away**2).mean()))
    yield Figure("patch: all slip against the rate form, rms", WHOLE_BOUND, whole, "%")
