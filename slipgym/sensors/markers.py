"""Simulates markers in the gel of a pad: a field of shear as a camera sees it, and the forces it shows.

Each of 9 x 7 markers moves in proportion to the friction on its part of the pad. A patch gives that friction
cell by cell; other contacts give a wrench alone, which is spread over the pad like its pressure: uniformly
within the radius of the contact, the torque as forces in proportion to the distance. Either way the field
adds up to the wrench. Sums over the noisy field are the forces that the sensor reports.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact.kinds import PATCHES
from slipgym.contact.pressure import OUTER_RADII
from slipgym.contact.records import LOAD, Z_X, Z_Y, X, Y
from slipgym.sensors.misalignment import about
from slipgym.sensors.noise import standard_normal

COLUMNS, ROWS = 9, 7
COUNT = COLUMNS * ROWS
"""Markers of a pad, row by row from its lower left corner."""
FRAMES = 4
"""Frames that are kept, for the latency."""
_UNIFORM = OUTER_RADII["uniform"]
_OF_WORLDS = PATCHES + 1
"""Dimensions of the cells of many worlds, if they are patches."""
_GAIN, _NORMAL = 1 << 23, (1 << 23) + 1
"""Numbers of `share` beyond those of other sensors."""
MARKERS = np.dtype(
    [
        ("compliance", "f8"),  # displacement of a marker over the force on its part [m/N]
        ("noise", "f8"),  # of its position per axis and frame [m]
        ("latency", "i8"),  # frames
        ("gain_error", "f8"),  # largest, of the compliance [-]
        ("normal_error", "f8"),  # largest, of the normal force [-]
        ("spacing", "f8", 2),  # of columns and rows [m]
        ("key", "u8"),  # of the noise
        ("gain", "f8"),  # displacement over what the compliance says [-]
        ("normal_gain", "f8"),  # normal force read over the true one [-]
        ("frames", "i8"),  # taken since reset
        ("field", "f8", (FRAMES, COUNT, 2)),  # displacements in the newest frames, in turn [m]
        ("seen", "f8", (COUNT, 2)),  # displacements in the frame delivered last [m]
    ]
)
"""The markers of one pad."""


@compiled
def start_markers(markers: Any, key: int) -> None:
    """Begin an episode of the markers of a pad, with the key of their noise."""
    markers.key, markers.frames = key, 0
    markers.gain = 1.0 + about(key, _GAIN, markers.gain_error)
    markers.normal_gain = 1.0 + about(key, _NORMAL, markers.normal_error)
    markers.field[:] = 0.0
    markers.seen[:] = 0.0


@compiled
def place_of(markers: Any, k: int) -> tuple[float, float]:
    """Position of marker k from the pad's centre in the pad frame [m]."""
    x = (k % COLUMNS - 0.5 * (COLUMNS - 1)) * markers.spacing[0]
    return x, (k // COLUMNS - 0.5 * (ROWS - 1)) * markers.spacing[1]


@compiled
def nearest(markers: Any, x: float, y: float) -> Any:
    """The marker next to a point of the pad frame [m]."""
    column = np.int64(np.rint(x / markers.spacing[0] + 0.5 * (COLUMNS - 1)))
    row = np.int64(np.rint(y / markers.spacing[1] + 0.5 * (ROWS - 1)))
    return min(max(row, 0), ROWS - 1) * COLUMNS + min(max(column, 0), COLUMNS - 1)


@compiled
def forces_of(markers: Any, field: np.ndarray) -> tuple[float, float, float]:
    """Force and torque at the pad's centre, in the pad frame, of a field of displacements (COUNT, 2)."""
    fx, fy, tau = 0.0, 0.0, 0.0
    for k in range(COUNT):
        x, y = place_of(markers, k)
        fx += field[k, 0]
        fy += field[k, 1]
        tau += x * field[k, 1] - y * field[k, 0]
    return fx / markers.compliance, fy / markers.compliance, tau / markers.compliance


@compiled
def _spread_evenly(markers: Any, pad: Any, weights: np.ndarray) -> None:
    """Share of the load of each marker (COUNT,) under a uniform pressure with the radius of the contact."""
    cx, cy = pad.pressure_centre
    outer = _UNIFORM * pad.radius
    for k in range(COUNT):
        x, y = place_of(markers, k)
        weights[k] = 1.0 if (x - cx) ** 2 + (y - cy) ** 2 <= outer * outer else 0.0
    weights[nearest(markers, cx, cy)] = 1.0
    weights /= weights.sum()


@compiled
def _take_patch(markers: Any, pad: Any, patch: np.ndarray, weights: np.ndarray, field: np.ndarray) -> None:
    """Load of the cells next to each marker, and the force of their bristles in a unit of its own."""
    weights[:] = 0.0
    cx, cy = pad.pressure_centre
    for c in range(patch.shape[1]):
        load = patch[LOAD, c]
        k = nearest(markers, cx + pad.radius * patch[X, c], cy + pad.radius * patch[Y, c])
        weights[k] += load
        field[k, 0] -= load * patch[Z_X, c]
        field[k, 1] -= load * patch[Z_Y, c]


@compiled
def press(markers: Any, pad: Any, cells: Any, i: int, f: int) -> None:
    """Take a frame: the displacement of each marker under the friction on finger f of environment i.

    The forces of a patch's bristles give the pattern, scaled so that they fit the friction best; a uniform
    force and a turn, weighted by the load, make up what is left, so that the field adds up to the wrench.
    """
    weights, field = np.empty(COUNT), markers.field[markers.frames % FRAMES]
    field[:] = 0.0
    if cells is None:
        _spread_evenly(markers, pad, weights)
    elif cells.ndim == _OF_WORLDS:
        _take_patch(markers, pad, cells[i, f], weights, field)
    else:
        _spread_evenly(markers, pad, weights)
    fx, fy = -pad.wrench[0], -pad.wrench[1]
    tau = -pad.wrench[2] + pad.pressure_centre[0] * fy - pad.pressure_centre[1] * fx
    field *= markers.compliance
    own = forces_of(markers, field)
    size = own[0] ** 2 + own[1] ** 2 + (own[2] / pad.radius) ** 2
    if size > 0.0:
        scale = (own[0] * fx + own[1] * fy + own[2] * tau / pad.radius**2) / size
        field *= max(scale, 0.0)
        fx, fy = fx - max(scale, 0.0) * own[0], fy - max(scale, 0.0) * own[1]
        tau -= max(scale, 0.0) * own[2]
    mx, my, spread = 0.0, 0.0, 0.0
    for k in range(COUNT):
        x, y = place_of(markers, k)
        mx, my = mx + weights[k] * x, my + weights[k] * y
    for k in range(COUNT):
        x, y = place_of(markers, k)
        spread += weights[k] * ((x - mx) ** 2 + (y - my) ** 2)
    turn = (tau - mx * fy + my * fx) / max(spread, 1e-12)
    for k in range(COUNT):
        x, y = place_of(markers, k)
        part = markers.gain * markers.compliance * weights[k]
        field[k, 0] = markers.gain * field[k, 0] + part * (fx - turn * (y - my))
        field[k, 1] = markers.gain * field[k, 1] + part * (fy + turn * (x - mx))
        if markers.noise > 0.0:
            for a in range(2):
                number = 2 * (COUNT * markers.frames + k) + a
                field[k, a] += markers.noise * standard_normal(markers.key, number)
    markers.frames += 1


@compiled
def seen_forces(markers: Any, mirror: float, reading: np.ndarray) -> None:
    """Write what the newest delivered frame shows into a reading (6,) of the force/torque sensor.

    Its normal force and the moments that show the centre of pressure stay, but for their scale. `mirror` is
    +1 for finger 1, -1 for finger 2.
    """
    newest = markers.frames - 1 - markers.latency
    for k in range(COUNT):
        for a in range(2):
            markers.seen[k, a] = markers.field[newest % FRAMES, k, a] if newest >= 0 else 0.0
    fx, fy, tau = forces_of(markers, markers.seen)
    reading[0], reading[1], reading[5] = fx, fy, mirror * tau
    for a in range(2, 5):
        reading[a] *= markers.normal_gain
