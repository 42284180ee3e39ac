"""The limit surface of a uniform disc as a table, and the closest point on it.

In the half plane (f_t, tau / r) over mu f_n the surface is the curve that `estimator.limit_surface` gives
over the distance of the centre of rotation. It is described by its support function: for the normal
N(s) = (s, 1 - s), s in [0, 1] from spin to translation,

    H(s) = N . c(s),    c = (H + (1 - s) H', H - s H'),

with c(s) the point of the curve where N is its normal. The table interpolates H with its first two
derivatives (quintic Hermite), and everything else is derived from that one function. The surface is therefore
convex and smooth, and the closest point on it is the gradient of a convex function, as the Newton iteration
of `slipgym.contact.coupled` needs. It differs from the exact disc by less than 5e-6.
"""

from __future__ import annotations

import math

import numpy as np

from estimator._numba.uncompiled import uncompiled
from estimator.limit_surface import DISC_RADIUS, disc_friction
from slipgym._numba.compiled import compiled
from slipgym.contact.records import Symmetric, Vector

INTERVALS = 256
ITERATIONS = 20
NEAR = 0.05
"""Step from the first guess above which the table's guess is taken [-]."""
INNER = 0.93
"""A ball of this radius lies within the surface of radius 1 [-]."""


def _support() -> np.ndarray:
    """Coefficients of H over the position in each interval, lowest power first, (INTERVALS, 6)."""
    s = np.linspace(0.0, 1.0, INTERVALS + 1)
    step = 1.0 / INTERVALS

    plain = uncompiled(disc_friction)

    def curve(positions: np.ndarray) -> np.ndarray:
        # v_t / (r omega) = s / (1 - s), and r is DISC_RADIUS of the disc's
        with np.errstate(divide="ignore"):
            ratios = DISC_RADIUS * positions / (1.0 - positions)
        return np.array([plain(float(ratio)) for ratio in ratios]) / (1.0, DISC_RADIUS)

    points = curve(s)
    value = s * points[:, 0] + (1.0 - s) * points[:, 1]
    slope = points[:, 0] - points[:, 1]
    # the second derivative: of the exact first one, by differences over a hundredth of an interval
    small = 0.01 * step
    low, high = np.maximum(s - small, 0.0), np.minimum(s + small, 1.0)
    ends = [p[:, 0] - p[:, 1] for p in (curve(low), curve(high))]
    bend = (ends[1] - ends[0]) / (high - low)
    a, b, c = value[:-1], slope[:-1] * step, 0.5 * bend[:-1] * step**2
    # what is left of value, slope and bend at the other end
    d = value[1:] - a - b - c
    e = slope[1:] * step - b - 2.0 * c
    f = bend[1:] * step**2 - 2.0 * c
    return np.column_stack(
        (a, b, c, 10.0 * d - 4.0 * e + 0.5 * f, -15.0 * d + 7.0 * e - f, 6.0 * d - 3.0 * e + 0.5 * f)
    )


def _guesses() -> np.ndarray:
    """S at the points of the curve that lie at f_t / (f_t + tau / r) = k / INTERVALS."""
    s = np.linspace(0.0, 1.0, 8 * INTERVALS + 1)
    points = np.array([_at(x)[1:] for x in s])
    return np.interp(np.linspace(0.0, 1.0, INTERVALS + 1), points[:, 0] / points.sum(axis=1), s)


def _at(s: float) -> tuple[float, float, float]:
    h, slope, _ = support.py_func(s)  # type: ignore[attr-defined]
    return h, h + (1.0 - s) * slope, h - s * slope


_TABLE = _support()


@compiled
def support(s: float) -> Vector:
    """H and its first two derivatives at s in [0, 1]."""
    place = s * INTERVALS
    i = min(int(place), INTERVALS - 1)
    x = place - i
    a, b, c, d, e, f = _TABLE[i]
    value = a + x * (b + x * (c + x * (d + x * (e + x * f))))
    slope = b + x * (2.0 * c + x * (3.0 * d + x * (4.0 * e + x * 5.0 * f)))
    bend = 2.0 * c + x * (6.0 * d + x * (12.0 * e + x * 20.0 * f))
    return value, slope * INTERVALS, bend * INTERVALS * INTERVALS


_GUESSES = _guesses()


@compiled
def closest(t: float, m: float, size: float, s: float) -> tuple[float, float, float, float]:
    """Closest point of a surface of a size to a point (t, m) outside or on it, tangential and torque over r.

    Both components are >= 0, the size is > 0; s is a first guess in [0, 1], for instance that of the last
    point.

    Returns:
        Its s; the point's two components; radius of curvature of the surface over that plus the distance to
        the point [-]. A point inside gives the last one above 1.
    """
    for k in range(ITERATIONS):
        h, slope, bend = support(s)
        square = s * s + (1.0 - s) * (1.0 - s)
        skew = 1.0 - 2.0 * s
        away = t * (1.0 - s) - m * s - size * (h * skew + slope * square)
        fall = t + m - size * (2.0 * h + skew * slope - bend * square)
        change = away / fall
        if k == 0 and not abs(change) < NEAR:
            place = t / (t + m) * INTERVALS
            i = min(int(place), INTERVALS - 1)
            s = _GUESSES[i] + (place - i) * (_GUESSES[i + 1] - _GUESSES[i])
            continue
        new = min(max(s + change, 0.0), 1.0)
        change = new - s
        if abs(change) < 1e-11:
            break
        s = new
    across = t * s + m * (1.0 - s) - size * h  # distance times the length of N
    # radius of curvature: |dc/ds| over the turn of N, bend * sqrt(square) / (1 / square)
    curvature = size * bend * square * math.sqrt(square)
    distance = across / math.sqrt(square)
    return s, size * (h + (1.0 - s) * slope), size * (h - s * slope), curvature / (curvature + distance)


@compiled
def project(y: Vector, size: float, guess: float) -> tuple[Vector, Symmetric, float]:
    """Closest point of the disc of a size > 0 to a scaled vector, from a guess of its place on the curve.

    Returns:
        The point; its derivative by the vector (xx, yy, tt, xy, xt, yt); the place on the curve, in [0, 1],
        negative if the vector lies within the disc.
    """
    planar = math.sqrt(y[0] * y[0] + y[1] * y[1])
    spin = abs(y[2])
    whole = 1.0, 1.0, 1.0, 0.0, 0.0, 0.0
    if planar * planar + spin * spin <= (INNER * size) ** 2:
        return y, whole, -1.0
    s, t, m, tangential = closest(planar, spin, size, guess)
    if tangential >= 1.0:
        return y, whole, -1.0
    sign = 1.0 if y[2] >= 0.0 else -1.0
    around = tangential  # as across, where there is no direction
    e_x, e_y = 1.0, 0.0
    if planar > 1e-9 * size:
        around = t / planar
        e_x, e_y = y[0] / planar, y[1] / planar
    per_square = 1.0 / (s * s + (1.0 - s) * (1.0 - s))
    tt, ts, ss = (1.0 - s) * (1.0 - s) * per_square, -s * (1.0 - s) * per_square, s * s * per_square
    radial = tangential * tt
    return (
        (t * e_x, t * e_y, sign * m),
        (
            radial * e_x * e_x + around * e_y * e_y,
            radial * e_y * e_y + around * e_x * e_x,
            tangential * ss,
            (radial - around) * e_x * e_y,
            sign * tangential * ts * e_x,
            sign * tangential * ts * e_y,
        ),
        s,
    )
