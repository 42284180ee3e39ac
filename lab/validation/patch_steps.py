"""Compares time steps of the distributed contact along a velocity profile: 0.1 ms and 0.01 ms."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from slipgym.contact import DistributedContact
from slipgym.synthetic import Course
from slipgym.validation.bench import Figure

BOUND = 0.1  # [%]
STEP = 1e-4  # [s]
REFINEMENT = 10


def profile() -> Course:
    """10 s of linear, rotational and planar slip up to 25 mm/s and 2.5 rad/s, with stops and reversals."""
    still = {"v_x": 0.0, "v_y": 0.0, "omega": 0.0}
    pieces = [
        ("stick", 0.2, {}),
        ("linear", 0.3, {"v_x": 0.025}),
        ("linear", 0.7, {}),
        ("reversal", 0.4, {"v_x": -0.025}),
        ("linear", 0.4, {"normal": 6.5}),
        ("stop", 0.3, still),
        ("stick", 0.3, {}),
        ("rotational", 0.3, {"omega": 2.5}),
        ("rotational", 0.6, {}),
        ("reversal", 0.4, {"omega": -2.0}),
        ("rotational", 0.4, {"normal": 4.0}),
        ("stop", 0.3, still),
        ("stick", 0.3, {}),
        ("planar", 0.3, {"v_x": 0.012, "v_y": 0.010, "omega": 1.5}),
        ("planar", 0.7, {}),
        ("turning", 0.8, {"v_x": -0.015, "v_y": 0.005}),
        ("turning", 0.8, {"v_y": -0.010, "omega": -2.0}),
        ("reversal", 0.6, {"v_x": 0.020, "v_y": 0.015, "omega": 0.8}),
        ("planar", 0.7, {}),
        ("slow", 0.3, {"v_x": 0.0004, "v_y": 0.0003, "omega": 0.02}),
        ("slow", 0.4, {}),
        ("stop", 0.2, still),
        ("stick", 0.3, {}),
    ]
    course = Course.start(normal=5.0)
    for label, duration, changes in pieces:
        course = course.to(label, duration, **changes)
    return course


def friction(course: Course, step: float, every: int, contact: DistributedContact) -> np.ndarray:
    """Scaled friction (f_x, f_y, tau / r) along a course.

    Args:
        course: The course; its twist and its normal force are taken.
        step: Step of the contact [s].
        every: Steps between two rows.
        contact: The patch, at rest.

    Returns:
        Shape (n, 3) [N].
    """
    n = round(course.times[-1] / step)
    ends = step * np.arange(1, n + 1)
    twists = course.at(ends - 0.5 * step)[:3].T.tolist()
    normals = course.at(ends)[3].tolist()
    rows = []
    for k, (twist, normal) in enumerate(zip(twists, normals, strict=True), 1):
        wrench = contact.step(twist, normal, step)
        if k % every == 0:
            rows.append(wrench)
    return np.array(rows) / (1.0, 1.0, contact.effective_radius)


def step_difference(course: Course, pressure: str = "uniform", cells: int = 21) -> float:
    """What ten times smaller steps change along a course, root mean square over the largest friction [-]."""
    coarse = friction(course, STEP, 1, DistributedContact(cells=cells, pressure=pressure))
    fine = friction(course, STEP / REFINEMENT, REFINEMENT, DistributedContact(cells=cells, pressure=pressure))
    away, size = np.linalg.norm(coarse - fine, axis=1), np.linalg.norm(fine, axis=1)
    return float(np.sqrt((away**2).mean()) / size.max())


def patch_steps() -> Iterator[Figure]:
    """The whole profile, 1e5 and 1e6 steps of 21 x 21 cells."""
    course = profile()
    away = 100.0 * step_difference(course)
    yield Figure(f"patch: steps of 0.1 and 0.01 ms, {course.times[-1]:.0f} s, rms", BOUND, away, "%")
