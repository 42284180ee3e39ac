"""Compares the distributed contact in steady slip at a prescribed twist with the exact limit surfaces."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from lab.limit_surface_exact import FRICTION, exact_friction
from slipgym.contact import DistributedContact
from slipgym.contact.pressure import OUTER_RADII
from slipgym.validation.bench import Figure

RADIUS = 0.015  # [m]
NORMAL = 5.0  # [N]
MU_C, MU_S = 0.4, 0.55
SURFACE_BOUND = 0.5  # [%]
# A centre of rotation under the patch lies in one cell. The error of that cell's friction is up to its load,
# with a lever of up to 1.7 r. At 21 x 21 that alone is 0.5 %; a rim has few cells, with larger loads
SLIP_CELLS = {"uniform": 23, "hertz": 23, "rim": 81}
SPIN_BOUND = 0.2  # [%]
# The friction of a cell at the distance d from the centre of rotation is off by (h / d)^2 / 24; all together
# by h^2 ln(1 / h), so that 41 cells a side leave (21 / 41)^2 ln(41) / ln(21) of what 21 leave
CONVERGENCE_BOUND = 0.32
ROUNDING = 1e-9  # [%]


def surface_twists(inclinations: int = 121, azimuths: int = 16) -> np.ndarray:
    """Directions of scaled slip, gamma_t from 0 to 1, all around; shape (inclinations * azimuths, 3)."""
    tilt = np.linspace(0.0, 0.5 * math.pi, inclinations)[:, None]
    azimuth = 2.0 * math.pi * np.arange(azimuths) / azimuths
    planar = np.cos(tilt)
    twists = (planar * np.cos(azimuth), planar * np.sin(azimuth), np.sin(tilt) + 0.0 * azimuth)
    return np.stack(twists, axis=-1).reshape(-1, 3)


def steady_friction(contact: DistributedContact, twists: np.ndarray, steps: int = 12) -> np.ndarray:
    """Friction in steady slip, by the contact's own steps; without viscous friction.

    Args:
        contact: The patch; made with `RADIUS`, `MU_C` and sigma_2 = 0.
        twists: Directions of scaled slip, shape (m, 3).
        steps: Each is a slip of 10 mm, where the bristles reach 0.5 um.

    Returns:
        Scaled friction over mu_c f_n, shape (m, 3).
    """
    r = contact.effective_radius
    found = np.zeros(twists.shape)
    for k, (v_x, v_y, spin) in enumerate(twists.tolist()):
        contact.reset()
        for _ in range(steps):
            f_x, f_y, tau = contact.step((v_x, v_y, spin / r), NORMAL, 0.01)
        found[k] = f_x, f_y, tau / r
    return found / (MU_C * NORMAL)


def friction_error(pressure: str, cells: int, twists: np.ndarray) -> np.ndarray:
    """Steady friction less that of the exact limit surface at the same slip.

    Args:
        pressure: A named pressure.
        cells: Along either side.
        twists: Directions of scaled slip, shape (m, 3).

    Returns:
        Scaled, over mu_c f_n, shape (m, 3) [-].
    """
    contact = DistributedContact(RADIUS, cells, pressure, MU_C, MU_C, sigma_2=0.0)
    outer = OUTER_RADII[pressure]
    expected = exact_friction(pressure, twists * (1.0, 1.0, outer)) * (1.0, 1.0, outer)
    return steady_friction(contact, twists) - expected


def surface_figures(pressure: str) -> Iterator[Figure]:
    """Steady friction against the exact limit surface, for all directions of slip.

    Limit surfaces are convex, and friction is the point of the surface that takes most power. So the largest
    error of the power at unit scaled speed is the Hausdorff distance of the two surfaces, whatever the
    twist that leads to a point; friction at the same twist may lie elsewhere on the surface.
    """
    twists = surface_twists()
    error = friction_error(pressure, 21, twists)
    distance, name = np.abs((error * twists).sum(axis=1)).max(), f"patch, {pressure}"
    yield Figure(f"{name}: limit surface, 21 x 21 cells", SURFACE_BOUND, 100.0 * float(distance), "%")
    rms = math.sqrt((error**2).sum(axis=1).mean())
    yield Figure(f"{name}: friction at the same slip, rms", SURFACE_BOUND, 100.0 * rms, "%")
    cells = SLIP_CELLS[pressure]
    largest = float(np.linalg.norm(friction_error(pressure, cells, twists), axis=1).max())
    yield Figure(f"{name}: the same, largest, {cells} x {cells}", SURFACE_BOUND, 100.0 * largest, "%")
    if pressure != "rim":
        fine = math.sqrt((friction_error(pressure, 41, twists) ** 2).sum(axis=1).mean())
        yield Figure(f"{name}: rms of 41 x 41 over 21 x 21", CONVERGENCE_BOUND, fine / rms, "1")


def patch_surface() -> Iterator[Figure]:
    """Translation, spin, and all directions between, of the named pressures."""
    for name in FRICTION:
        outer = OUTER_RADII[name]
        contact = DistributedContact(RADIUS, 21, name, MU_C, MU_C, sigma_2=0.0)
        away = steady_friction(contact, np.array([[0.6, 0.8, 0.0]]))[0] + (0.6, 0.8, 0.0)
        yield Figure(f"patch, {name}: translation", ROUNDING, 100.0 * float(np.abs(away).max()), "%")
        radius = -steady_friction(contact, np.array([[0.0, 0.0, 1.0]]))[0, 2] * contact.effective_radius
        away = abs(radius * outer / RADIUS - 1.0)
        yield Figure(f"patch, {name}: radius in spin, 21 x 21 cells", SPIN_BOUND, 100.0 * float(away), "%")
        yield from surface_figures(name)
