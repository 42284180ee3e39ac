"""A box slides between pads whose friction changes with the logarithm of speed, by another integrator."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from slipgym.validation.bench import Bench, Friction

MASS, FORCE, MU_C, MU_S, V_S = 0.2, 1.5, 0.4, 0.55, 1e-3


def fallen(slope: float, speed: float, times: np.ndarray) -> np.ndarray:
    """Distance that a box of a speed [m/s] has slid at some times [m]."""

    def rates(_, state):
        sliding = MU_C * (1.0 + slope * np.log(min(max(state[1], 1e-4), 1.0) / 0.01))
        level = sliding + (MU_S - sliding) * np.exp(-((state[1] / V_S) ** 2))
        return state[1], 9.81 - 2.0 * FORCE * (level + 0.2 * state[1]) / MASS

    return solve_ivp(rates, (0.0, times[-1]), (0.0, speed), "LSODA", times, rtol=1e-10, atol=1e-12).y[0]


@pytest.mark.parametrize("contact", ["ellipsoid", "distributed"])
@pytest.mark.parametrize("slope", [-0.1, 0.1])
def test_a_box_slides_as_the_equation_says(slope, contact):
    overrides = {
        "contact": {"speed_slope": slope, "cells": 5},
        "gripper": {"lag": 0.0, "dead_time": 0.0},
        "physics": {"gravity": 9.81},
    }
    with Bench(overrides, Friction(mu_s=MU_S, mu_c=MU_C), 6.0, contact=contact, engine="planar") as bench:
        bench.settle()
        bench.run(2 / 120, force=lambda _: FORCE)
        start, speed = bench.plant.world["com"][0, 1], -bench.plant.world["velocity"][0, 1]
        trace = bench.run(0.1, force=lambda _: FORCE)
    times = np.arange(1, len(trace.time) + 1) / 120
    expected = fallen(slope, speed, times)
    # backward Euler leads by half a sub-step of 0.25 ms
    np.testing.assert_allclose(start - trace.position[:, 1], expected, rtol=2e-3, atol=2e-5)
    assert abs(expected[-1] - fallen(0.0, speed, times)[-1]) > 1e-3
