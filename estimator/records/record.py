"""A record of one finger: two streams, each at its own rate, in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Rows = NDArray[np.intp]


@dataclass(frozen=True)
class Record:
    """Forces and slip velocities of one finger.

    Wrench and twist are at the centre of pressure (CoP), where the columns allowed to move them there.
    """

    name: str
    """Name of its file."""
    force_t: Array
    """Time of each force sample, increasing, (n,) [s]."""
    wrench: Array
    """f_x, f_y, f_n, tau, (n, 4) [N, N, N, N m]."""
    cop: Array | None
    """Centre of pressure by force sample, (n, 2) [m]; None: the record does not say."""
    twist_t: Array
    """Time of each velocity sample, increasing, (m,) [s]."""
    twist: Array
    """v_x, v_y, omega at the sensor's origin, (m, 3) [m/s, m/s, rad/s]."""
    truth: Array | None
    """mu_s, mu_c, r by force sample, (n, 3) [-, -, m], NaN where unknown; None: the record has none."""
    hold: float | None = None
    """Time for which the file repeats each velocity, of which the record has one [s]; None: it does not."""
    periods: tuple[float, float] | None = None
    """Usual times between two forces and two velocities, where they are known [s]; None: the medians."""
    grip: Array | None = None
    """Force of the gripper itself by force sample, (n,) [N], NaN where unknown; None: the record has none."""
    doubt: str = ""
    """Why the unit of its time may be another one; empty: it is clear."""


def seconds(t: Any) -> str:
    """A time to the microsecond [s], whatever its origin."""
    return f"{t:.6f}".rstrip("0").rstrip(".")


def wrench_at(wrench: Array, cop: Array) -> Array:
    """Moves wrenches (n, 4) from the sensor's origin to the CoP (n, 2) [m]: tau - c × f_t.

    It changes the torque in its place, which a long record has memory for.
    """
    wrench[:, 3] -= cop[:, 0] * wrench[:, 1] - cop[:, 1] * wrench[:, 0]
    return wrench


def twist_at(twist: Array, cop: Array) -> Array:
    """Twists (n, 3), moved from the sensor's origin to the CoP (n, 2) [m]: v + omega × c; a new array."""
    moved = twist.copy()
    moved[:, 0] -= twist[:, 2] * cop[:, 1]
    moved[:, 1] += twist[:, 2] * cop[:, 0]
    return moved


def cop_of_tilt(tilt: Array, f_n: Array, threshold: float) -> Array:
    """Centre of pressure (n, 2) [m] from the tilting torques: c = (-tau_y, tau_x) / f_n.

    Args:
        tilt: tau_x, tau_y at the sensor's origin, (n, 2) [N m].
        f_n: Normal force, (n,) [N].
        threshold: Normal force below which it is taken as the origin [N].
    """
    pressed = f_n >= threshold
    cop = np.stack((-tilt[:, 1], tilt[:, 0]), axis=1)
    cop /= np.where(pressed, f_n, 1.0)[:, None]
    cop *= pressed[:, None]
    return cop
