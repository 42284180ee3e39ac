"""A record for tests: a steady slide and turn on an ellipsoid, forces at 1000 Hz, velocities at 120 Hz."""

import numpy as np
import pandas as pd
import pytest

MU_C, R = 0.4, 0.012


@pytest.fixture
def table():
    """One table of 2 s; cells are NaN where their stream has no sample."""
    rng = np.random.default_rng(0)
    t = np.arange(1, 2001) / 1000
    f_n = 5.0 + 0.5 * np.sin(2 * np.pi * t)
    share = MU_C * f_n / np.sqrt(2.0)  # as much sliding as turning
    forces = pd.DataFrame({"t": t, "f_x": 0.0 * t, "f_y": share, "f_n": f_n, "tau": R * share})
    forces[["f_x", "f_y", "f_n"]] += 0.01 * rng.standard_normal((len(t), 3))
    at = np.arange(1, 241) / 120
    twists = pd.DataFrame({"t": at.round(6), "v_x": 0.0, "v_y": 0.02, "omega": 0.02 / R})
    return forces.assign(t=t.round(6)).merge(twists, how="outer", on="t", sort=True)


@pytest.fixture
def save(tmp_path):
    """Writes a table to a file, by the type in its name."""

    def write(frame, name="log.csv"):
        path = tmp_path / name
        if name.endswith(".parquet"):
            frame.to_parquet(path, index=False)
        else:
            frame.to_csv(path, index=False)
        return path

    return write
