"""Describes the slip, load and properties of a patch over time, linear between points."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from slipgym.config.errors import unknown
from slipgym.contact.validation import check_friction, finite_vector, positive


class Point(NamedTuple):
    """State of a patch at a point in time."""

    v_x: float = 0.0
    """Slip velocity of the object along x [m/s]."""
    v_y: float = 0.0
    """Slip velocity of the object along y [m/s]."""
    omega: float = 0.0
    """Slip rate of rotation [rad/s]."""
    normal: float = 5.0
    """Normal force [N], > 0."""
    mu_c: float = 0.4
    """Coulomb friction [-], > 0."""
    mu_s: float = 0.55
    """Static friction [-], >= mu_c."""
    r: float = 0.010
    """Radius of the equivalent rim contact [m], > 0."""


@dataclass(frozen=True)
class Course:
    """The course of a patch, built piece by piece from `start`.

    An example: 2 s of sliding between two stops.

        course = Course.start(mu_c=0.4).to("stick", 0.2).to("slide", 0.1, v_x=0.02).to("slide", 2.0)
        course = course.to("stick", 0.1, v_x=0.0).to("stick", 0.2)
    """

    times: tuple[float, ...]
    """Start and ends of the k pieces, (k + 1,) [s]."""
    points: tuple[Point, ...]
    """The patch there, (k + 1,)."""
    labels: tuple[str, ...]
    """Phase that each piece belongs to, (k,)."""

    @classmethod
    def start(cls, **values: float) -> Course:
        """A course without pieces.

        Args:
            **values: Of `Point` at time 0; the others are its defaults.

        Raises:
            ValueError: A name is unknown, or a value is outside its range.
        """
        return cls((0.0,), (_changed(Point(), values),), ())

    def to(self, label: str, duration: float, **changes: float) -> Course:
        """This course and a piece in which some values change linearly.

        Args:
            label: Phase that the piece belongs to.
            duration: Of the piece [s], > 0.
            **changes: Values of `Point` at its end; the others stay.

        Raises:
            ValueError: A name is unknown, or a value is outside its range.
        """
        positive(duration=duration)
        return replace(
            self,
            times=(*self.times, self.times[-1] + duration),
            points=(*self.points, _changed(self.points[-1], changes)),
            labels=(*self.labels, label),
        )

    def at(self, t: np.ndarray) -> np.ndarray:
        """The patch at times t (n,) [s]: the fields of `Point` as rows, shape (7, n)."""
        return np.array([np.interp(t, self.times, values) for values in np.transpose(self.points)])

    def phases(self, t: np.ndarray) -> np.ndarray:
        """Phases at times t (n,) [s]; the end of a piece belongs to it."""
        later = np.asarray(self.times[1:-1])
        return np.array(self.labels)[np.searchsorted(later, t - 1e-9)]


def _changed(point: Point, changes: dict[str, float]) -> Point:
    for name in changes:
        if name not in Point._fields:
            raise ValueError(unknown("value of a course", name, Point._fields))
    changed = Point(*finite_vector("point", point._replace(**changes), len(point)).tolist())
    check_friction(changed.mu_c, changed.mu_s)
    positive(normal=changed.normal, r=changed.r)
    return changed
