"""The command that compares limit surfaces."""

import numpy as np
import pandas as pd

from lab.reproduction import reproduce_surface, surface
from lab.reproduction.fixed_point import disc_bias


def test_the_command_writes_what_it_names(tmp_path, monkeypatch):
    monkeypatch.setattr(surface, "CELLS", (5, 11))
    folder = reproduce_surface(tmp_path, progress=False)
    names = {"cells.csv", "cells.md", "bias.csv", "bias.md", "surface.png", "versions.json"}
    assert {path.name for path in folder.iterdir()} == names
    cells = pd.read_csv(folder / "cells.csv")
    assert len(cells) == 6
    errors = cells.set_index(["pressure", "cells"])
    for name in ("uniform", "hertz", "rim"):
        coarse, fine = errors.loc[(name, 5)], errors.loc[(name, 11)]
        assert (fine < 0.7 * coarse).all()
        assert (errors.loc[name]["surface_%"] < errors.loc[name]["slip_largest_%"]).all()
    bias = pd.read_csv(folder / "bias.csv")
    np.testing.assert_allclose(bias.iloc[1, 1:].tolist(), 100.0 * np.array(disc_bias(0.5)), rtol=1e-9)
