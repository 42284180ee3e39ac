"""Simulates logs of grippers on a bench, by another pressure, more cells and a finer step than the fit's."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from slipgym.contact.distributed_kernel import prescribed_step
from slipgym.contact.pressure import PressureName, patch_cells
from slipgym.contact.records import pads, patch
from slipgym.identification.log import COLUMNS, Log
from slipgym.identification.motions import MOTIONS
from slipgym.identification.parameters import DEVIATION, NAMES, START, values_of

FINE = 2000.0
"""Least rate of the contact [Hz]."""
CELLS = 11


@dataclass(frozen=True)
class HiddenGripper:
    """A gripper that a fit shall find."""

    values: dict[str, float]
    """Value of each parameter, by name."""
    noise: np.ndarray
    """Standard deviation of each reading, (7,)."""


def draw_gripper(seed: int) -> HiddenGripper:
    """A gripper sampled from the prior, within one and a half of its deviations."""
    rng = np.random.default_rng(seed)
    deviations = np.clip(rng.normal(size=len(START)), -1.5, 1.5)
    values = dict(zip(NAMES, values_of(START + DEVIATION * deviations).tolist(), strict=True))
    noise = rng.uniform(0.5, 2.0) * np.array([0.02, 0.02, 0.04, 5e-4, 5e-4, 5e-4, 0.02])
    return HiddenGripper(values, noise)


def simulated_log(
    gripper: HiddenGripper,
    seed: int = 0,
    rate: float = 120.0,
    pressure: PressureName = "hertz",
    names: tuple[str, ...] = tuple(MOTIONS),
) -> Log:
    """The log of a session of motions, five seconds each, with sensor noise.

    The patch has another pressure and more cells than the fit's: its limit surface and break-away are others.
    """
    parts = [MOTIONS[name](np.arange(round(5.0 * rate)) / rate) for name in names]
    command, motion = (np.concatenate(each) for each in zip(*parts, strict=True))
    of = gripper.values
    steps = int(np.ceil(FINE / rate))
    h, n = 1.0 / (rate * steps), len(command)
    positions, loads = patch_cells(pressure, CELLS)
    radius = of["r"] / float(loads @ np.hypot(*positions.T))
    pad = pads(
        1,
        r=radius,
        mu_c=of["mu_c"],
        mu_s=of["mu_c"] * (1.0 + of["static excess"]),
        stribeck_velocity=of["v_s"],
        sigma_0=1e6,
        sigma_1=80.0,
        sigma_2=of["sigma_2"],
        load_exponent=of["load exponent"],
        radius_exponent=of["radius exponent"],
        compliance=of["shear compliance"],
        shear_time=1e-3,
    )
    cells, x, y = patch(positions, loads), of["cop x"], of["cop y"]
    middle, ends = (np.arange(n * steps) + 0.5) / steps, (np.arange(n * steps) + 1.0) / steps
    twist = np.stack([np.interp(middle, np.arange(n), motion[:, a]) for a in range(3)], axis=1)
    served = np.maximum(np.floor(ends - of["dead time"] * rate + 1e-9), 0).astype(int)
    aims, kept = of["force gain"] * command[np.minimum(served, n - 1)], np.exp(-h / of["lag"])
    force, loads_at = of["force gain"] * command[0], np.zeros((n * steps, 4))
    for m, (aim, (v_x, v_y, omega)) in enumerate(zip(aims.tolist(), twist.tolist(), strict=True)):
        force = aim + (force - aim) * kept
        wrench = prescribed_step(pad, cells, v_x - omega * y, v_y + omega * x, omega, force, h)
        f_x, f_y, tau = (-each for each in wrench)
        loads_at[m] = f_x, f_y, force, tau + x * f_y - y * f_x
    at, late = np.arange(n) / rate, of["wrench latency"]
    wrenches = [np.interp(at - late, ends / rate, loads_at[:, a]) for a in range(4)]
    moved = np.vstack([np.zeros(3), np.cumsum(twist * h, axis=0)])
    past = at - of["slip latency"]
    until = [
        [np.interp(past - back, np.arange(n * steps + 1) * h, moved[:, a]) for a in range(3)]
        for back in (0.0, 1.0 / rate)
    ]
    readings = np.stack([*wrenches, *((np.array(until[0]) - until[1]) * rate)], axis=1)
    readings[:, :4] += [of[f"zero {axis}"] for axis in ("f_x", "f_y", "f_n", "tau")]
    readings += gripper.noise * np.random.default_rng(seed).normal(size=readings.shape)
    return Log(rate, command, motion, readings)


def write_log(log: Log, path: Path) -> None:
    """Writes a log as csv."""
    t = np.arange(len(log.command)) / log.rate
    rows = np.column_stack([t, log.command, log.motion, log.readings])
    np.savetxt(path, rows, fmt="%.9g", delimiter=",", header=",".join(COLUMNS), comments="")
