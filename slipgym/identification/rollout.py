"""Rolls out many grippers along one log: grip command and motion in, readings out.

Each is the force loop of `slipgym.world.actuator`, a soft pad with or without cells under the log's motion,
and late sensors. Times need not be whole sub-steps: readings are smooth in all of them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact import distributed_kernel, soft_kernel
from slipgym.contact.pressure import patch_cells
from slipgym.contact.records import CELL_FIELDS, DISC, ELLIPSOID, pads, patch, rest, rest_cells
from slipgym.identification.parameters import NAMES

SUBSTEP = 1.5e-3
"""Longest sub-step of a rollout [s]."""
LOOSE = 0.05  # [N]; a pad pressed less has no friction
SURFACES = {"distributed": ELLIPSOID, "disc": DISC, "ellipsoid": ELLIPSOID}
"""Contact models, and the limit surface of those without cells."""
CELLS, FINE_CELLS = 5, 9
"""Along each side of a patch: 25 cells carry load, or 77, with which its error is small beside the noise."""
CHANNELS = ("f_x", "f_y", "f_n", "tau", "v_x", "v_y", "omega")
"""Columns of the readings: load on the finger at the pad's centre, slip twist there."""


def roll(
    values: np.ndarray,
    rate: float,
    command: np.ndarray,
    motion: np.ndarray,
    contact: str,
    pressure: str = "uniform",
    cells: int = CELLS,
    substep: float = SUBSTEP,
) -> np.ndarray:
    """Readings of n grippers.

    Args:
        values: Parameters in the order of `PARAMETERS`, (n, p).
        rate: Rows per second of the log [Hz].
        command: Grip force commanded from each row on, (rows,) [N].
        motion: Twist of the object against the gripper at each row, (rows, 3) [m/s, m/s, rad/s].
        contact: Friction model, of `SURFACES`.
        pressure: Over a distributed patch.
        cells: Along each side of it.
        substep: Longest sub-step [s].

    Returns:
        (n, rows, 7), see `CHANNELS`.
    """
    patches, unit = np.zeros((CELL_FIELDS, 0)), 1.0
    if contact == "distributed":
        positions, loads = patch_cells(pressure, cells)
        patches, unit = patch(positions, loads), 1.0 / float(loads @ np.hypot(*positions.T))
    column = dict(zip(NAMES, np.ascontiguousarray(values.T), strict=True))
    pad = pads_of(column, len(values), unit * column["r"], SURFACES[contact])
    pad["cop"] = np.stack([column["cop x"], column["cop y"]], axis=1)
    names = ("force gain", "dead time", "lag", "wrench latency", "slip latency")
    times = np.stack([column[name] for name in names], axis=1)
    out = np.zeros((len(values), len(command), len(CHANNELS)))
    substeps = math.ceil(1.0 / (rate * substep))
    trace = np.zeros((len(command) * substeps, 4))
    # what has moved until each row, for the mean of a late velocity
    moved = np.zeros_like(motion)
    moved[1:] = np.cumsum(0.5 * (motion[1:] + motion[:-1]), axis=0)
    _roll(pad, patches, times, rate, substeps, np.ascontiguousarray(command), motion, moved, trace, out)
    for k, axis in enumerate(("f_x", "f_y", "f_n", "tau")):
        out[:, :, k] += column[f"zero {axis}"][:, None]
    return out


def pads_of(
    column: Mapping[str, Any], n: int, radius: Any, surface: int = SURFACES["distributed"]
) -> np.ndarray:
    """PAD (n,) of parameters by name, each a number or (n,); `radius` is that of its law [m]."""
    return pads(
        n,
        surface=surface,
        mu_c=column["mu_c"],
        mu_s=column["mu_c"] * (1.0 + column["static excess"]),
        stribeck_velocity=column["v_s"],
        sigma_0=1e6,
        sigma_1=80.0,
        sigma_2=column["sigma_2"],
        r=radius,
        load_exponent=column["load exponent"],
        radius_exponent=column["radius exponent"],
        compliance=column["shear compliance"],
        shear_time=1e-3,
    )


@compiled
def _roll(
    pad: np.ndarray,
    cells: np.ndarray,
    times: np.ndarray,
    rate: float,
    substeps: int,
    command: np.ndarray,
    motion: np.ndarray,
    moved: np.ndarray,
    trace: np.ndarray,
    out: np.ndarray,
) -> None:
    """Fill `out` (n, rows, 7); `trace` (rows substeps, 4) is scratch."""
    h, rows = 1.0 / (rate * substeps), len(command)
    twist = np.zeros(3)
    for i in range(len(pad)):
        gain, dead, lag, late, slip_late = times[i]
        kept = math.exp(-h / lag) if lag > 0.0 else 0.0
        force = gain * command[0]
        rest_cells(cells)
        for m in range(rows * substeps):
            due = m + 1 - dead * rate * substeps
            before = math.floor(due)
            share = due - before
            now, last = command[max(before, 0) // substeps], command[max(before - 1, 0) // substeps]
            aim = gain * (share * now + (1.0 - share) * last)
            force = aim + (force - aim) * kept
            place = (m + 0.5) / substeps
            k = min(int(place), rows - 2)
            for a in range(3):
                twist[a] = motion[k, a] + (place - k) * (motion[k + 1, a] - motion[k, a])
            cx, cy = pad[i].cop
            twist[0] -= twist[2] * cy
            twist[1] += twist[2] * cx
            if force > LOOSE:
                if cells.shape[1] > 0:
                    one = pad[i : i + 1]
                    distributed_kernel.prescribed_step(one, cells, twist[0], twist[1], twist[2], force, h)
                else:
                    pad[i].normal = force
                    soft_kernel.prescribed_step(pad[i], twist, h)
                fx, fy, tau = -pad[i].wrench[0], -pad[i].wrench[1], -pad[i].wrench[2]
            else:
                rest(pad[i : i + 1])
                rest_cells(cells)
                fx, fy, tau = 0.0, 0.0, 0.0
            trace[m, 0], trace[m, 1], trace[m, 2], trace[m, 3] = fx, fy, force, tau + cx * fy - cy * fx
        for k in range(rows):
            place = min(max((k - late * rate) * substeps - 1.0, 0.0), rows * substeps - 1.0)
            m = min(int(place), rows * substeps - 2)
            for a in range(4):
                out[i, k, a] = trace[m, a] + (place - m) * (trace[m + 1, a] - trace[m, a])
            for a in range(3):
                end = moved_until(moved, a, k - slip_late * rate)
                out[i, k, 4 + a] = end - moved_until(moved, a, k - 1.0 - slip_late * rate)


@compiled
def moved_until(moved: np.ndarray, axis: int, place: float) -> float:
    """Displacement until a place between rows, times the rate [m/s]."""
    place = min(max(place, 0.0), len(moved) - 1.0)
    k = min(int(place), len(moved) - 2)
    return moved[k, axis] + (place - k) * (moved[k + 1, axis] - moved[k, axis])
