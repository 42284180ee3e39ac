import itertools

import numpy as np
import pandas as pd
import pytest

from policies.study.config import Study
from slipgym.config.yaml_model import validate

BULLET, CORE = "PyBullet, ellipsoid", "core"


@pytest.fixture(scope="session")
def nothing(tmp_path_factory):
    """A folder without learned policies."""
    return str(tmp_path_factory.mktemp("shelf"))


@pytest.fixture(scope="session")
def small(nothing):
    """Makes studies of short slides: two worlds, two blocks of one episode, no learned policies."""

    def make(**changes):
        values = {
            "name": "small",
            "blocks": 2,
            "episodes": 1,
            "tasks": ["LinearSlip"],
            "learned": nothing,
            "presets": ["train"],
            "worlds": [
                {"label": BULLET, "engine": "bullet", "contact": "ellipsoid"},
                {"label": CORE, "engine": "planar", "contact": "ellipsoid", "sources": ["estimated"]},
            ],
            "config": {
                "tasks": {"linear_slip": {"duration": 0.2, "settle": 0.05, "hold": 0.05, "distance": 0.01}}
            },
        }
        return validate({**values, **changes}, Study, "test")

    return make


@pytest.fixture(scope="session")
def invented():
    """Makes tables of episodes in which each source solves a given number of every ten."""

    def make(solved, task="Hold", world=BULLET, kind="classic", blocks=3):
        rows = []
        for source, block, episode in itertools.product(solved, range(blocks), range(10)):
            success = episode < solved[source]
            rows.append(
                {
                    "world": world,
                    "task": task,
                    "preset": "train",
                    "change": "",
                    "level": 0.0,
                    "kind": kind,
                    "source": source,
                    "estimator": "disc" if source == "estimated" else "",
                    "block": block,
                    "seed": 100 * block + episode,
                    "episode": episode,
                    "success": success,
                    "dropped": not success and episode % 2 == 1,
                    "return": 10.0 * solved[source] + np.sin(7.0 * episode + block),
                    "mean_force_N": 5.0,
                }
            )
        return pd.DataFrame(rows)

    return make
