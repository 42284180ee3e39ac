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
from lab.reproduction.tables import grid
from policies.evaluation.frames import distinct, values, where
from policies.evaluation.plots.style import STYLE, styled
from policies.versions import stamped, write_versions
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
        The run's folder: slopes.csv, lock_out.csv, table.md with both, map.png, lock_out.png.
    """
    maps = {
        (name, f_n): errors(name, GAMMAS, RADII, f_n, progress)
        for name in estimator.names()
        for f_n in FORCES
    }
    path = stamped(output, "coupling")
    with new_folder(path) as folder:
        write_versions(folder)
        tables = {"slopes": slopes(), "lock_out": shares(maps)}
        for name, table in tables.items():
            table.to_csv(folder / f"{name}.csv", index=False)
        (folder / "table.md").write_text(page(**tables), encoding="utf-8")
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


def page(slopes: pd.DataFrame, lock_out: pd.DataFrame) -> str:
    """Both as Markdown: a row for each gamma_t, and a row for each force with a column for each estimator.

    Args:
        slopes: From `slopes`.
        lock_out: From `shares`.
    """
    columns = ("gamma_t", "numerical", "closed_form")
    cells = zip(*(values(slopes, column) for column in columns), strict=True)
    lines = [[f"{c:g}", *(f"{slope:.8f}".replace("-", "−") for slope in pair)] for c, *pair in cells]
    names = distinct(lock_out, "estimator")
    rows = [
        [f"{f_n:g}", *(f"{100 * values(where(own, estimator=name), 'still_off')[0]:.0f} %" for name in names)]
        for f_n, own in lock_out.groupby("f_n_N", sort=False)
    ]
    first = grid(["c", "T' by central difference", "closed form"], lines)
    second = grid(["normal force [N]", *(f'"{name}" still off' for name in names)], rows)
    return f"{first}\n\n{second}\n"
