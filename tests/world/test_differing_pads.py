"""Two pads that differ, on either engine."""

import gymnasium as gym
import numpy as np
import pytest

from slipgym.contact import records
from slipgym.validation.bench import Bench, Friction

MU, SPLIT, MASS, GRIP = 0.4, 0.25, 0.2, 2.2


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_each_pad_slides_with_its_own_friction(engine):
    with Bench(
        friction=Friction(mu_s=MU, mu_c=MU), force=20.0, size=(0.08, 0.03, 1.0), engine=engine
    ) as bench:
        for field in ("mu_s", "mu_c"):
            bench.plant.pads[field] *= [1.0 - SPLIT, 1.0 + SPLIT]
        bench.settle()
        trace = bench.run(0.3, force=lambda _: GRIP)
        wrench, pads = bench.plant.pads["wrench"][0], bench.plant.pads[0]
        speed = float(np.linalg.norm(trace.twist[-1, :2]))
        sigma_2 = bench.config.contact.sigma_2
    assert speed > 0.05
    expected = pads["normal"] * (pads["mu_c"] + sigma_2 * speed)
    assert np.linalg.norm(wrench[:, :2], axis=1) == pytest.approx(expected, rel=5e-3)
    assert pads["mu_c"] == pytest.approx([0.3, 0.5])
    assert trace.slip[-1, 2] == pytest.approx(0.0, abs=1e-9)  # equal lever, no torque


@pytest.mark.parametrize(
    ("array", "field"),
    [
        ("pads", "sigma_0"),
        ("pads", "sigma_2"),
        ("pads", "stribeck_velocity"),
        ("pads", "stribeck_exponent"),
        ("pads", "dwell"),
        ("cells", records.LOAD),
    ],
)
def test_what_differs_between_the_fingers_is_not_lost(array, field):
    """The planar engine solves one pad for both only where nothing of parameters and state differs."""
    contact, config = ("distributed", {"contact": {"cells": 5}}) if array == "cells" else ("ellipsoid", None)
    env = gym.make("slipgym/LinearSlip-v0", engine="planar", contact=contact, config=config).unwrapped
    env.reset(seed=0, options={"initial_force": 5.0})
    numbers = getattr(env.simulation.plant, array)
    numbers = numbers[:, :, field] if array == "cells" else numbers[field]
    numbers[0, 1] = 1.01 * numbers[0, 1] + 0.01
    before = numbers[0].copy()
    env.step([-0.9])
    np.testing.assert_array_equal(numbers[0], before)  # hard pads do not age
    env.close()


def test_a_finger_that_is_weaker_stays_so():
    env = gym.make("slipgym/LinearSlip-v0", engine="planar").unwrapped
    env.reset(seed=0)
    fingers = env.simulation.plant.fingers[0]
    fingers["force_limit"][1] = 2.0
    for _ in range(20):
        env.step([0.0])
    assert fingers["force"][0] > 10.0
    assert fingers["force"][1] == pytest.approx(2.0, abs=1e-3)
    env.close()
