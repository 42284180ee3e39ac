"""The yardstick in numpy does what the compiled patch does."""

import numpy as np
import pytest

from lab.benchmarking import measure
from lab.benchmarking.numpy_patch import NumpyPatch
from slipgym.contact import DistributedContact


@pytest.mark.parametrize("pressure", ["uniform", "hertz", "rim"])
def test_equals_the_compiled_patch(pressure):
    rng = np.random.default_rng(4)
    contact = DistributedContact(cells=9, pressure=pressure)
    plain = NumpyPatch(contact.positions, contact.shares)
    seen = []
    for _ in range(500):  # sticks, slips and creeps through the Stribeck speed
        twist = 10.0 ** rng.uniform(-6.0, -1.0) * rng.normal(size=3) * (1.0, 1.0, 100.0)
        normal, h = rng.uniform(1.0, 10.0), 10.0 ** rng.uniform(-5.0, -3.0)
        ours = contact.step(twist, normal, h)
        theirs = plain.step(tuple(twist), normal, h)
        np.testing.assert_allclose(theirs, ours, rtol=1e-11, atol=1e-12)
        seen.append(np.hypot(*contact.bristles.T).max() > 0.39e-6)
    assert 0.1 < np.mean(seen) < 0.999


def test_the_figures_of_the_patch_add_up():
    cells, plain, ratio, alone = (figure.value for figure in measure.patch(pairs=9, steps=100))
    assert 0.0 < cells < plain
    assert alone == pytest.approx(plain / cells)
    assert ratio > 6.0  # 4 if the loops over the cells take one at a time, 20 and more if they take eight
