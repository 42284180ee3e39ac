"""The smoother that knows all but the unknowns: its law, and that it finds what was drawn."""

import math

import numpy as np
import pytest

from estimator.augmented.parameters import AdaptiveParameters
from estimator.augmented.slip_law import COP, MU, SHAPE, SIGMA, TILT, ZERO, R
from lab.leaderboard.smoother import (
    LATE,
    LEVER,
    MOMENT,
    SHIFT,
    UNKNOWNS,
    Slips,
    _law,
    compared,
    smoothed,
    spreads,
)

P = AdaptiveParameters().as_array().view(np.recarray)[0]
TRUTH = {"mu_s": 0.5, "mu_c": 0.4, "r": 0.005}


def drawn(seed, sensors="lab", instants=60):
    """Slips of all directions with errors of the sensors as a preset samples them."""
    rng = np.random.default_rng(seed)
    x = rng.normal(size=UNKNOWNS) * spreads(sensors)
    x[MU], x[R], x[SIGMA], x[SHAPE], x[LATE] = math.log(0.4), math.log(0.005), 0.2, 0.0, 0.0
    speed, angle = rng.uniform(0.005, 0.03, instants), rng.uniform(-1.5, 1.5, instants)
    spin = rng.uniform(-4.0, 4.0, instants)
    twists = np.stack([speed * np.cos(angle), speed * np.sin(angle), spin], axis=1)
    wrenches = np.zeros((instants, 4))
    wrenches[:, 2] = rng.uniform(2.0, 6.0, instants)
    data = Slips(wrenches, twists, twists, np.zeros(2), 1.0, TRUTH, {})
    noise = rng.normal(size=(instants, 3)) * (P.sd_force, P.sd_force, P.sd_torque)
    wrenches[:, [0, 1, 3]] = _law(P, x, data, twists)[0] + noise
    both = np.stack([twists, twists]) + rng.normal(size=(2, instants, 3)) * (
        P.sd_speed,
        P.sd_speed,
        P.sd_spin,
    )
    return x, data._replace(before=both[0], after=both[1])


def test_derivatives():
    x, data = drawn(0)
    x = x + 0.1 * np.isin(np.arange(UNKNOWNS), np.arange(LEVER, LATE))
    twists = data.before
    _, by_x, by_twist = _law(P, x, data, twists)
    for j in (MU, R, SIGMA, ZERO, TILT, COP, COP + 1, *range(LEVER, LATE)):
        step = np.zeros(UNKNOWNS)
        step[j] = 1e-4
        slope = (_law(P, x + step, data, twists)[0] - _law(P, x - step, data, twists)[0]) / 2e-4
        np.testing.assert_allclose(by_x[:, :, j], slope, rtol=0.02, atol=2e-3 * np.abs(slope).max() + 1e-9)
    for j, size in enumerate((1e-5, 1e-5, 1e-3)):
        step = np.zeros(3)
        step[j] = size
        slope = (_law(P, x, data, twists + step)[0] - _law(P, x, data, twists - step)[0]) / (2.0 * size)
        np.testing.assert_allclose(by_twist[:, :, j], slope, rtol=0.05, atol=0.02 * np.abs(slope).max())


@pytest.mark.parametrize("sensors", ["realistic", "lab"])
def test_it_finds_what_was_drawn(sensors):
    """Mean squares of errors over deviations, of 24 fits: within 1 +- 0.9, three deviations."""
    spread, off = spreads(sensors), []
    for seed in range(24):
        x, data = drawn(seed, sensors)
        found, covariance = smoothed(data, spread, 0.0)
        off.append([(found[at] - x[at]) / covariance[at, at] ** 0.5 for at in (MU, R)])
    squares = np.mean(np.square(off), axis=0)
    assert np.all(squares < 1.9)
    assert np.all(squares > 0.1)


def test_good_sensors_have_no_errors():
    assert np.all(spreads("realistic")[ZERO:SHAPE] < 1e-3)
    assert spreads("lab")[SHIFT] == pytest.approx(1.4 / 3.0**0.5)
    assert spreads("lab")[MOMENT] > 0.1


@pytest.mark.slow
def test_with_good_sensors_an_episode_tells_almost_all():
    """Noise alone leaves 1 %, as the covariance says; the errors of "lab" several times that."""
    table = compared(16, 0).set_index(["pads", "sensors"])
    for pads in ("ellipsoid", "disc"):
        good, lab = table.loc[(pads, "realistic")], table.loc[(pads, "lab")]
        assert good["fingers"] > 20
        for name in ("mu_c", "r"):
            assert good[f"{name} smoother"] < 2.0 * good[f"{name} expected"] < 3.0
            assert lab[f"{name} smoother"] > 2.0 * good[f"{name} smoother"]
