"""The sub-step's benchmark holds its box as it says."""

from copy import deepcopy

import numpy as np
import pytest

from lab.benchmarking import substeps
from lab.benchmarking.measure import Player

pytestmark = pytest.mark.slow  # they compile a program that only the benchmark runs


@pytest.fixture(scope="module")
def plant():
    player = Player("slipgym/LinearSlip-v0")
    yield deepcopy(player.rest())
    player.env.close()


def speeds(plant, forces, blocks=60, steps=50) -> np.ndarray:
    """Slip speed after every few sub-steps."""
    plant, speed = deepcopy(plant), np.empty(blocks)
    for i in range(blocks):
        rows = plant.world[0], plant.pads[0], None, plant.fingers[0], plant.slip_sensors[0]
        substeps.repeat(*rows, np.roll(forces, -i * steps), steps)
        speed[i] = np.hypot(*plant.world["relative_velocity"][0, :2])
    return speed


def test_the_regimes_are_stick_slide_and_both(plant):
    found = {name: speeds(start, forces) for name, start, forces in substeps.regimes(plant)}
    assert found["stick"].max() < 1e-9
    # static friction in the first two sub-steps takes 2 h 2 f_n (mu_s - mu_c) / m = 0.9 mm/s
    np.testing.assert_allclose(found["slide"], substeps.SPEED, rtol=0.05)
    assert found["stick-slip"].max() > 0.01
    assert np.mean(found["stick-slip"] < 1e-5) > 0.2


def test_a_figure_per_regime(plant):
    figures = substeps.substeps(plant, repeats=3)
    assert [figure.name for figure in figures] == [
        "sub-step, stick",
        "sub-step, slide",
        "sub-step, stick-slip",
    ]
    assert all(figure.value > 1.0 for figure in figures)
