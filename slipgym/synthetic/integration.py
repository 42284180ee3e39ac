"""Integrates the friction of a patch along a course in fine steps, and records it at the control rate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from slipgym.contact import DistributedContact, EllipsoidContact
from slipgym.synthetic.course import Course

RATE = 120
"""Control rate [Hz]."""
SUBSTEPS = 84
"""Steps of the contact per control step: one is 0.1 ms."""


@dataclass(frozen=True)
class Trace:
    """Ground truth at the n sampling instants."""

    t: np.ndarray
    """Time, (n,) [s]."""
    wrench: np.ndarray
    """Friction (f_x, f_y, tau) on the object at the instant, (n, 3) [N, N, N m]."""
    normal: np.ndarray
    """Normal force at the instant, (n,) [N]."""
    twist: np.ndarray
    """Slip twist (v_x, v_y, omega) at the instant, (n, 3) [m/s, m/s, rad/s]."""
    motion: np.ndarray
    """Slip displacement (x, y, theta) since the instant before, (n, 3) [m, m, rad]."""
    mu_s: np.ndarray
    """Static friction, (n,) [-]."""
    mu_c: np.ndarray
    """Coulomb friction, (n,) [-]."""
    r: np.ndarray
    """Radius of the equivalent rim contact, (n,) [m]."""
    phase: np.ndarray
    """Label of the course's phase, (n,)."""


def integrate(course: Course, contact: DistributedContact | EllipsoidContact | None = None) -> Trace:
    """Drives a patch along a course.

    Friction and radius change once per control step, twist and normal force at every step of the contact.

    Args:
        course: The course.
        contact: The patch, which forgets its past first; by default a uniform disc. Its friction
            and its radius become the course's.

    Returns:
        The trace at 120 Hz; its first instant is 1/120 s, its last the last full sample of the course.
    """
    contact = contact or DistributedContact()
    n = int(course.times[-1] * RATE * (1.0 + 1e-9))
    t = np.arange(1, n + 1) / RATE
    v_x, v_y, omega, normal, mu_c, mu_s, r = course.at(t)
    dt = 1.0 / (RATE * SUBSTEPS)
    ends = np.arange(1, n * SUBSTEPS + 1) * dt
    twists = course.at(ends - 0.5 * dt)[:3].T
    normals = course.at(ends)[3].reshape(n, SUBSTEPS).tolist()
    motion = twists.reshape(n, SUBSTEPS, 3).sum(axis=1) * dt
    steps = twists.reshape(n, SUBSTEPS, 3).tolist()
    wrench = np.zeros((n, 3))
    contact.reset()
    for k in range(n):
        contact.change(mu_c=mu_c[k], mu_s=mu_s[k], effective_radius=r[k])
        for twist, force in zip(steps[k], normals[k], strict=True):
            friction = contact.step(twist, force, dt)
        wrench[k] = friction
    return Trace(
        t=t,
        wrench=wrench,
        normal=normal,
        twist=np.stack([v_x, v_y, omega], axis=1),
        motion=motion,
        mu_s=mu_s,
        mu_c=mu_c,
        r=r,
        phase=course.phases(t),
    )
