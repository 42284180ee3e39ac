"""Reads the friction of two silicones on PLA and fits the power law of `load_exponent` to it.

The set has a mean coefficient of friction for each cycle, at one speed and without torque or time: an
estimator has nothing to estimate in it. One row of the extract is all cycles of a rig under one load.
"""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import numpy as np
import pandas as pd

from lab.pushes.run import value_and_interval
from policies.data.fetch import read
from policies.data.sets import SETS

FILE = "CoF-Measurements.csv"
EXTRACT = Path(__file__).with_name("silicone.csv")
FEWEST = 6
"""Loads from which there are halves and a bootstrap."""


def reduced(folder: Path) -> pd.DataFrame:
    """Rig and material, load [N], number of cycles and their mean friction, of the set in a folder.

    Raises:
        ValueError: The file is missing or another one.
    """
    raw = pd.read_csv(BytesIO(read(SETS["silicone"], folder, FILE)))
    of_each = raw.groupby(["DataName", "NominalLoad"], sort=False)["CoF.mean"]
    table = of_each.agg(cycles="size", mu="mean").rename_axis(["rig", "load"]).reset_index()
    return table.assign(load=1e-3 * table["load"])


def exponent(load: np.ndarray, mu: np.ndarray) -> float:
    """The exponent a of mu = c load^-a by least squares of the logarithms [-]; NaN if all loads are one."""
    if len(np.unique(load)) < 2:
        return np.nan
    return -float(np.polyfit(np.log(load), np.log(mu), 1)[0])


def off_the_law(load: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """Friction over that of the fitted law, less 1, (n,) [-]."""
    law = np.polyfit(np.log(load), np.log(mu), 1)
    return mu / np.exp(np.polyval(law, np.log(load))) - 1.0


def exponents(table: pd.DataFrame, number: int, seed: int) -> pd.DataFrame:
    """A row for each rig: exponents with 95 % intervals of a bootstrap over loads, and what is off the law.

    Args:
        table: Of `reduced`, or the extract.
        number: Of bootstrap resamples.
        seed: Of the resamples.
    """
    return pd.DataFrame(list(_rows(table, number, np.random.default_rng(seed))))


def _rows(table: pd.DataFrame, number: int, rng: np.random.Generator) -> Iterator[dict[str, object]]:
    for rig, own in table.groupby("rig", sort=False):
        load, mu = own["load"].to_numpy(float), own["mu"].to_numpy(float)
        lower = load <= np.median(load)
        off = 100.0 * off_the_law(load, mu)
        few = len(np.unique(load)) < FEWEST
        yield {
            "rig": rig,
            "loads [N]": f"{load.min():g}…{load.max():g}",
            "number": len(own),
            "a": f"{exponent(load, mu):.2f}" if few else _interval(load, mu, number, rng),
            "lower half": "–" if few else _interval(load[lower], mu[lower], number, rng),
            "upper half": "–" if few else _interval(load[~lower], mu[~lower], number, rng),
            "off the law, sd [%]": float(off.std(ddof=1)),
            "largest [%]": float(np.abs(off).max()),
        }


def _interval(load: np.ndarray, mu: np.ndarray, number: int, rng: np.random.Generator) -> str:
    drawn = rng.integers(0, len(load), (number, len(load)))
    again = [exponent(load[index], mu[index]) for index in drawn]
    finite = [value for value in again if np.isfinite(value)]
    return value_and_interval(np.array([exponent(load, mu), *finite]), 2)
