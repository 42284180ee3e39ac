"""The wrist goes no faster than the gripper allows."""

import numpy as np
import pytest

from slipgym.validation.bench import Bench


@pytest.mark.parametrize(
    ("asked", "given"),
    [
        ((0.3, -0.4, 2.0), (0.3, -0.4, 2.0)),  # 0.5 m/s, just allowed
        ((0.6, -0.8, -9.0), (0.3, -0.4, -3.0)),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    ],
)
def test_targets_beyond_the_limits_are_brought_down(asked, given):
    with Bench() as bench:
        bench.world.command_wrist(np.array(asked), 0.1)
        np.testing.assert_allclose(bench.plant.world["wrist_acceleration"][0], np.array(given) / 0.1)
