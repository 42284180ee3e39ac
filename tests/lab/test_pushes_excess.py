"""How much farther off an estimator is than the best of four, on known deviations."""

import numpy as np
import pandas as pd

from lab.pushes.excess import REFERENCES, excesses


def test_the_excess_is_that_over_the_best_of_each_resample():
    sizes = {
        "adaptive": [4.0, -1.0],
        "ukf": [-1.0, 3.0],
        "disc": [2.0, 2.0],
        "joint": [5.0, 5.0],
        "rls": [9.0, 9.0],
    }
    rows = [
        {"log": "one", "estimator": name, **dict.fromkeys(REFERENCES, np.array(v))}
        for name, v in sizes.items()
    ]
    own = excesses(pd.DataFrame(rows), "r")["one"]
    assert {name: excess.tolist() for name, excess in own.items()} == {
        "adaptive": [3.0, -1.0],
        "ukf": [0.0, 1.0],
        "disc": [1.0, 0.0],
        "joint": [4.0, 3.0],
        "rls": [8.0, 7.0],
    }
