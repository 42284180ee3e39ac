"""Limit surfaces: exact, of the cells, and the ellipsoid."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pandas as pd
from tqdm import tqdm

from lab.limit_surface_exact import FRICTION
from lab.reproduction.fixed_point import disc_bias
from lab.reproduction.surface_plot import plot_surface
from lab.validation.patch_surface import friction_error, surface_twists
from policies.evaluation.frames import markdown
from policies.evaluation.plots.style import STYLE, styled
from policies.versions import stamped, write_versions
from slipgym.atomic_io import new_folder

CELLS = (11, 15, 21, 31, 41, 81)
GAMMAS = (0.3, 0.5, 0.707, 0.8, 0.9)


def reproduce_surface(output: str | os.PathLike[str] = "runs", progress: bool = True) -> Path:
    """Compares limit surfaces of a disc under three pressures with those of its cells and the ellipsoid.

    Args:
        output: Folder that the run's own folder goes to.
        progress: Whether to show progress bars.

    Returns:
        The run's folder: cells.csv and bias.csv with their Markdown, surface.png.
    """
    tables = {"cells": convergence(progress), "bias": bias()}
    path = stamped(output, "surface")
    with new_folder(path) as folder:
        write_versions(folder)
        for name, table in tables.items():
            table.to_csv(folder / f"{name}.csv", index=False)
            (folder / f"{name}.md").write_text(markdown(table, digits=3), encoding="utf-8")
        with styled():
            plot_surface(GAMMAS).savefig(folder / "surface.png", dpi=STYLE.dpi)
    return path


def convergence(progress: bool = True) -> pd.DataFrame:
    """Steady friction of cells against the exact limit surface, for all directions of slip.

    Returns:
        Per pressure and number of cells along a side, in % of mu_c f_n: distance of the limit surfaces, and
        root mean square and largest distance of friction at the same slip.
    """
    twists = surface_twists()
    rows = []
    jobs = [(pressure, cells) for pressure in FRICTION for cells in CELLS]
    for pressure, cells in tqdm(jobs, desc="cells", unit="patch", disable=not progress):
        error = 100.0 * friction_error(pressure, cells, twists)
        surface = np.abs((error * twists).sum(axis=1)).max()
        length = np.linalg.norm(error, axis=1)
        rows.append((pressure, cells, surface, np.sqrt((length**2).mean()), length.max()))
    return pd.DataFrame(rows, columns=["pressure", "cells", "surface_%", "slip_rms_%", "slip_largest_%"])


def bias() -> pd.DataFrame:
    """Where the ellipsoid's equations rest on a uniform disc, in %."""
    rows = [(gamma_t, *(100.0 * error for error in disc_bias(gamma_t))) for gamma_t in GAMMAS]
    return pd.DataFrame(rows, columns=["gamma_t", "mu_c_%", "r_%"])
