"""Rotations in space: quaternions (x, y, z, w), rotation vectors, inertia and angular velocity."""

from __future__ import annotations

import math
from typing import TypeAlias

from slipgym._numba.compiled import compiled
from slipgym.contact.records import Symmetric, Vector

Quaternion: TypeAlias = tuple[float, float, float, float]


@compiled
def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """The rotation b followed by a."""
    return (
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
        a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
        a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
    )


@compiled
def turned(q: Quaternion, spin: Vector, time: float) -> Quaternion:
    """The rotation q after some time [s] at an angular velocity on the axes that q turns to [rad/s].

    It is short of the angle by its cube over 12.
    """
    half = 0.5 * time
    x, y, z, w = product((half * spin[0], half * spin[1], half * spin[2], 1.0), q)
    scale = 1.0 / math.sqrt(x * x + y * y + z * z + w * w)
    return scale * x, scale * y, scale * z, scale * w


@compiled
def rotation_between(before: Quaternion, after: Quaternion) -> Vector:
    """Rotation vector from one rotation to another, on the outer axes [rad]."""
    x, y, z, w = product(after, (-before[0], -before[1], -before[2], before[3]))
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    sine = math.sqrt(x * x + y * y + z * z)
    scale = 2.0 if sine < 1e-9 else 2.0 * math.atan2(sine, w) / sine
    return scale * x, scale * y, scale * z


@compiled
def angle_in_plane(q: Quaternion) -> float:
    """Angle of a rotation about -y, the grip axis, apart from its tilt [rad]."""
    return -2.0 * math.atan2(q[1], q[3])


@compiled
def with_angle(q: Quaternion, angle: float) -> Quaternion:
    """A rotation of the same tilt with another angle about -y [rad]."""
    length = math.sqrt(q[1] * q[1] + q[3] * q[3])
    tilt = product(q, (0.0, -q[1] / length, 0.0, q[3] / length))
    return product(tilt, (0.0, -math.sin(0.5 * angle), 0.0, math.cos(0.5 * angle)))


@compiled
def upright(q: Quaternion) -> Vector:
    """The object's y axis."""
    x, y, z, w = q
    return 2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)


@compiled
def inertia_tensor(q: Quaternion, mass: float, gyration: Vector) -> Symmetric:
    """Inertia (xx, yy, zz, xy, xz, yz) on the outer axes of an object with a rotation q [kg m^2].

    `gyration` are the squared radii of gyration about its own axes [m^2].
    """
    x, y, z, w = q
    a = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)
    b = upright(q)
    c = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)
    i, j, k = mass * gyration[0], mass * gyration[1], mass * gyration[2]
    return (
        i * a[0] * a[0] + j * b[0] * b[0] + k * c[0] * c[0],
        i * a[1] * a[1] + j * b[1] * b[1] + k * c[1] * c[1],
        i * a[2] * a[2] + j * b[2] * b[2] + k * c[2] * c[2],
        i * a[0] * a[1] + j * b[0] * b[1] + k * c[0] * c[1],
        i * a[0] * a[2] + j * b[0] * b[2] + k * c[0] * c[2],
        i * a[1] * a[2] + j * b[1] * b[2] + k * c[1] * c[2],
    )


@compiled
def times(tensor: Symmetric, vector: Vector) -> Vector:
    """Product of a symmetric tensor with a vector."""
    xx, yy, zz, xy, xz, yz = tensor
    x, y, z = vector
    return xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z


@compiled
def spin_with(tensor: Symmetric, momentum: Vector, about_y: float) -> Vector:
    """Angular velocity whose y component is given, from x and z of the angular momentum [rad/s]."""
    xx, _, zz, xy, xz, yz = tensor
    l_x, l_z = momentum[0] - xy * about_y, momentum[2] - yz * about_y
    per = 1.0 / (xx * zz - xz * xz)
    return per * (zz * l_x - xz * l_z), about_y, per * (xx * l_z - xz * l_x)
