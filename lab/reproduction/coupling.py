"""The fixed-point map, the explicit iteration and the lock-out regions."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pandas as pd

import estimator
from lab.reproduction.fixed_point import Slip, slope, slope_closed_form
from lab.reproduction.lock_out import errors
from lab.reproduction.plots import plot_lock_out, plot_map
from policies.evaluation.folder import stamped
from policies.evaluation.plots.style import STYLE, styled
from policies.versions import write_versions
from slipgym.atomic_io import new_folder

GAMMAS = np.linspace(0.05, 0.99, 48)
RADII = np.geomspace(1e-3, 0.1, 41)  # [m]
FORCES = (1.0, 5.0, 20.0)  # [N]
TOLERANCE = 0.05


def reproduce_coupling(output: str | os.PathLike[str] = "runs", progress: bool = True) -> Path:
    """Checks the closed forms of the coupling numerically and maps where estimators lock out.

    Args:
        output: Folder that the run's own folder goes to.
        progress: Whether to show progress bars.

    Returns:
        The run's folder: slopes.csv, lock_out.csv, map.png, lock_out.png.
    """
    maps = {
        (name, f_n): errors(name, GAMMAS, RADII, f_n, progress)
        for name in estimator.names()
        for f_n in FORCES
    }
    path = stamped(output, "coupling")
    with new_folder(path) as folder:
        write_versions(folder)
        slopes().to_csv(folder / "slopes.csv", index=False)
        shares(maps).to_csv(folder / "lock_out.csv", index=False)
        with styled():
            plot_map().savefig(folder / "map.png", dpi=STYLE.dpi)
            plot_lock_out(maps, GAMMAS, RADII, TOLERANCE).savefig(folder / "lock_out.png", dpi=STYLE.dpi)
    return path


def slopes() -> pd.DataFrame:
    """T' at the truth, by difference and in closed form, over gamma_t."""
    gammas = (0.1, 0.3, 0.5, 0.7, 0.9, 0.99)
    rows = [(c, slope(Slip(c)), slope_closed_form(c)) for c in gammas]
    return pd.DataFrame(rows, columns=["gamma_t", "numerical", "closed_form"])


def shares(maps: dict[tuple[str, float], np.ndarray]) -> pd.DataFrame:
    """Share of the grid of starts and slips that is still off by `TOLERANCE`, per estimator and force."""
    rows = [(name, f_n, error.size, float((error > TOLERANCE).mean())) for (name, f_n), error in maps.items()]
    return pd.DataFrame(rows, columns=["estimator", "f_n_N", "starts", "still_off"])
