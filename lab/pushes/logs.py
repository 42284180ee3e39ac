"""Reads the logs of quasi-static pushes of github.com/robinzhoucmu/MLab_EXP and reduces each push to means.

The repository is under the Apache License 2.0, and its logs were made for J. Zhou, R. Paolini, J. A. Bagnell,
M. T. Mason, A Convex Polynomial Force-Motion Model for Planar Sliding (ICRA 2016). This module reads its data
files and uses none of its code.

A log begins with the number of pushes. A push is the pose of the block before and after (x y z [mm],
quaternion w x y z), a number and as many rows of the force sensor (t [s], two forces [N], 100 Hz), a number
and as many rows of the pusher (t [s], pose). The first force sample is the sensor's zero. The sensor turns
with the pusher, whose x axis is the direction of the push.
"""

from __future__ import annotations

import hashlib
import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from lab.pushes.sources import COMMIT, FOLDER, HELD_OUT, LOGS, REPOSITORY
from lab.pushes.support import CENTRE

SENSOR = np.sqrt(0.5) * np.array([[1.0, 1.0], [1.0, -1.0]])
"""Axes of the force sensor in the pusher's frame; the force on the block is minus the reading."""
CONTACT = 0.5
"""Fraction of the median force of the second half of a push, from which on the block is pushed."""


class RawPush(NamedTuple):
    """A push as logged, in the plane."""

    before: np.ndarray
    """Pose of the block (x, y, yaw) [m, m, rad]."""
    after: np.ndarray
    """The same after the push."""
    forces: np.ndarray
    """Times and readings of the force sensor, (n, 3) [s, N, N]."""
    pusher: np.ndarray
    """Times and poses (x, y, yaw) of the pusher, (k, 4) [s, m, m, rad]."""


def read_log(clone: Path, name: str) -> str:
    """The text of a log, if it is the one that the figures of this project were made from.

    Args:
        clone: Folder of a clone of the repository.
        name: One of `LOGS` or `HELD_OUT`.

    Raises:
        ValueError: The file's digest is another.
        OSError: It cannot be read.
    """
    log = (LOGS | HELD_OUT)[name]
    path = clone / FOLDER / log.path
    data = path.read_bytes()
    if not hashlib.sha256(data).hexdigest().startswith(log.sha256):
        raise ValueError(f"{path} is not the log of commit {COMMIT[:7]} of {REPOSITORY}: other SHA-256")
    return data.decode("ascii")


def parse(text: str) -> Iterator[RawPush]:
    """The pushes of a log; one without rows of a sensor is left out.

    Args:
        text: As the module says.

    Raises:
        ValueError: The text has another form.
    """
    lines = iter(text.split("\n"))

    def block(size: int, columns: int) -> np.ndarray:
        rows = [line.split() for line in itertools.islice(lines, size)]
        if len(rows) < size or any(len(row) != columns for row in rows):
            raise ValueError(f"expected {size} rows of {columns} numbers")
        return np.array(rows, dtype=float).reshape(size, columns)

    def number() -> int:
        return int(block(1, 1)[0, 0])

    for _ in range(number()):
        before, after = planar(block(2, 7))
        forces, pusher = block(number(), 3), block(number(), 8)
        if len(forces) == 0 or len(pusher) == 0:
            continue
        yield RawPush(before, after, forces, np.column_stack((pusher[:, 0], planar(pusher[:, 1:]))))


def planar(poses: np.ndarray) -> np.ndarray:
    """(x, y, yaw) [m, m, rad], (n, 3), of poses x y z [mm] and quaternion w x y z, (n, 7)."""
    x, y, _, w, i, j, k = poses.T
    return np.column_stack(
        (1e-3 * x, 1e-3 * y, np.arctan2(2.0 * (w * k + i * j), 1.0 - 2.0 * (j * j + k * k)))
    )


def turned(vectors: np.ndarray, angles: np.ndarray | float) -> np.ndarray:
    """Vectors (..., 2) rotated by angles (...) [rad]."""
    x, y, c, s = vectors[..., 0], vectors[..., 1], np.cos(angles), np.sin(angles)
    return np.stack((c * x - s * y, s * x + c * y), axis=-1)


def screw(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """The twist in the block's frame, about its centre of mass, that leads from one pose to the other.

    Args:
        before: Pose of the block (x, y, yaw) [m, m, rad].
        after: The same.

    Returns:
        (d_x, d_y, d_theta) [m, m, rad], constant in the frame of the moving block for a unit of time.
    """
    d_theta = np.remainder(after[2] - before[2] + np.pi, 2.0 * np.pi) - np.pi
    centres = [pose[:2] + turned(CENTRE, pose[2]) for pose in (before, after)]
    chord = turned(centres[1] - centres[0], -before[2] - 0.5 * d_theta)
    return np.append(chord / np.sinc(d_theta / (2.0 * np.pi)), d_theta)


def reduced(push: RawPush) -> np.ndarray:
    """Means of a push, the values of `lab.pushes.extract.COLUMNS`.

    The block is assumed to move by a constant twist while it is pushed, from the first force above `CONTACT`
    to the end.

    Returns:
        Mean wrench of the pusher on the block (f_x, f_y, tau) [N, N, N m] and the displacement
        (d_x, d_y, d_theta) [m, m, rad], both in the block's frame about its centre of mass; yaw of the block
        half way [rad]; mean place of the pusher in the frame of the supports (x, y) [m]; duration [s].

    Raises:
        ValueError: The pusher does not touch the block.
    """
    t, readings = push.forces[:, 0], push.forces[:, 1:] - push.forces[0, 1:]
    size = np.hypot(*readings.T)
    first = int(np.argmax(size > CONTACT * np.median(size[len(size) // 2 :])))
    t, local = t[first:], -readings[first:] @ SENSOR.T
    if len(t) < 2:
        raise ValueError("a push without contact")
    at, yaw = _followed(push.pusher, t)
    displacement = screw(push.before, push.after)
    angle = push.before[2] + displacement[2] * (t - t[0]) / (t[-1] - t[0])
    centre = (
        push.before[:2] + turned(CENTRE, push.before[2]) + _travelled(displacement, push.before[2], angle)
    )
    force = turned(turned(local, yaw), -angle)
    arm = turned(at - centre, -angle)
    tau = arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
    place = arm.mean(axis=0) + CENTRE
    middle = np.remainder(push.before[2] + 0.5 * displacement[2] + np.pi, 2.0 * np.pi) - np.pi
    return np.array([*force.mean(axis=0), tau.mean(), *displacement, middle, *place, t[-1] - t[0]])


def _followed(pusher: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions (n, 2) [m] and yaws (n,) [rad] of the pusher at times."""
    x, y, yaw = (np.interp(t, pusher[:, 0], column) for column in (*pusher.T[1:3], np.unwrap(pusher[:, 3])))
    return np.column_stack((x, y)), yaw


def _travelled(displacement: np.ndarray, yaw: float, angle: np.ndarray) -> np.ndarray:
    """How far the centre of mass has come, (n, 2) [m], when the block has an angle."""
    turn = angle - yaw
    share = turn / displacement[2] if displacement[2] != 0.0 else np.linspace(0.0, 1.0, len(angle))
    chord = displacement[:2] * (share * np.sinc(turn / (2.0 * np.pi)))[:, None]
    return turned(chord, yaw + 0.5 * turn)
