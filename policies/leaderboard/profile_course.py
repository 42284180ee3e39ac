"""The velocity profile: every kind of slip, stops between, friction and radius that change.

The paper (arXiv 2507.06824, its simulation) gives no numbers; these are of the size that the
gripper's pads see. Phases are long against the estimator's memory of 0.42 s of slip.
"""

from __future__ import annotations

import math

from estimator.limit_surface import DISC_RADIUS
from slipgym.synthetic import Course

RAMP = 0.25  # from rest to full speed and back [s]
REST = 0.25  # between two slips [s]
STOP = "stop"
STEADY = ("linear", "rotational", "planar", "large", "small", "more spin", "linear again")
"""Phases at whose ends friction and radius have been constant for at least 1.2 s."""


def profile() -> Course:
    """The course: linear, rotational, planar; from 6 s on friction and radius change while it slides."""
    course = Course.start(mu_c=0.40, mu_s=0.54, r=disc(0.012), normal=5.0).to(STOP, REST)
    course = slip(course, "linear", 1.5, 1.0, 0.020, normal=5.5)
    course = slip(course, "rotational", 1.2, 0.0, 0.016, normal=5.0)
    course = start(course, "planar", 0.7, 0.020).to("planar", 1.5)
    course = course.to("growing", 1.5, mu_c=0.55, mu_s=0.72, r=disc(0.015), normal=4.5)
    course = start(stop(course.to("large", 2.0)), "shrinking", 0.6, 0.020)
    course = course.to("shrinking", 1.5, mu_c=0.32, mu_s=0.43, r=disc(0.010), normal=5.5)
    course = stop(course.to("small", 2.0))
    course = slip(course, "more spin", 2.0, 0.5, 0.020)
    return slip(course, "linear again", 1.5, 1.0, 0.020, normal=5.0)


def slip(
    course: Course, label: str, duration: float, gamma_t: float, speed: float, **changes: float
) -> Course:
    """A slip from rest to rest, with the values that change while its speed is constant."""
    return stop(start(course, label, gamma_t, speed).to(label, duration, **changes))


def start(course: Course, label: str, gamma_t: float, speed: float) -> Course:
    """From rest to a slip with a share of translation and a scaled speed [m/s] at the present r."""
    omega = math.sqrt(1.0 - gamma_t**2) * speed / course.points[-1].r
    return course.to(label, RAMP, v_x=gamma_t * speed, omega=omega)


def stop(course: Course) -> Course:
    """To rest, and a while there."""
    return course.to(STOP, RAMP, v_x=0.0, omega=0.0).to(STOP, REST)


def disc(radius: float) -> float:
    """Radius of the equivalent rim contact of a uniform disc of this radius [m]."""
    return DISC_RADIUS * radius
