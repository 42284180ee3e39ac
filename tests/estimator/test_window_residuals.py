"""Residuals of the window's entries: their derivatives by the states against differences."""

import numpy as np
import pytest

import estimator
from estimator.window.fit import _limit
from estimator.window.layout import (
    BREAK,
    COP,
    FALL,
    FALLS,
    GROWS,
    MU,
    OLD,
    RATIO,
    SHAPE,
    SIGMA,
    SLIDE,
    STATES,
    TILT,
    TORQUE,
    ZERO,
    R,
)
from estimator.window.residuals import slide, stick

SPREADS = {MU: 0.5, RATIO: 0.1, R: 0.3, SHAPE: 0.3, SIGMA: 0.1, ZERO: 0.1, ZERO + 1: 0.1, TORQUE: 5e-4}
SPREADS |= {TILT: 0.02, TILT + 1: 0.02, COP: 5e-4, COP + 1: 5e-4, FALLS: 0.1, GROWS: 0.1}
SPREADS[OLD] = 0.2
P = estimator.AdaptiveParameters().as_array().view(np.recarray)[0]
SCALE = np.array([1.0, 1.0, 0.01])
"""Of forces [N] and torque [N m] at a few newtons."""


def drawn(rng, kind):
    """States and an entry whose speed is of the order of the Stribeck velocity or above."""
    x = np.zeros(STATES)
    x[MU], x[R], x[RATIO], x[SHAPE], x[SIGMA] = np.log(0.5), np.log(0.008), 0.2, 0.5, 0.2
    x += [SPREADS[j] * rng.uniform(-1.0, 1.0) for j in range(STATES)]
    s = estimator.make_batch("adaptive", 1).states.view(np.recarray)[0].entries[0]
    s.kind, s.load, s.slow = kind, rng.uniform(-1.0, 1.0), rng.uniform(0.2, 0.8)
    s.time = 0.1
    s.motion[:] = rng.uniform(-1.0, 1.0, 3) * (0.02, 0.02, 2.0)
    s.wrench[:] = *rng.uniform(-2.0, 2.0, 2), rng.uniform(1.0, 10.0), 0.02 * rng.uniform(-1.0, 1.0)
    return x, s


def residual(function, *arguments):
    e, h, var = np.zeros(3), np.zeros((3, STATES)), np.ones(3)
    function(*arguments, e, h, var)
    assert (var > 0.0).all()
    return e, h


def differences(of, x, step=1e-6):
    """Derivatives (3, 15) of what is expected: of the negative residual."""
    found = np.empty((3, STATES))
    for j in range(STATES):
        one = step * SPREADS[j] * np.eye(STATES)[j]
        found[:, j] = (of(x - one)[0] - of(x + one)[0]) / (2.0 * step * SPREADS[j])
    return found


@pytest.mark.parametrize("beside", [0.0, 1.0])
@pytest.mark.parametrize("old", [False, True])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_derivatives_of_a_slide(sign, old, beside):
    """At the wrench that is expected: Gauss-Newton leaves out what the residual itself contributes."""
    rng = np.random.default_rng(1)
    for _ in range(50):
        x, s = drawn(rng, SLIDE)
        x[[COP, COP + 1]] *= beside

        def of(states, s=s):
            return residual(slide, states, s, P, sign, old)

        s.wrench[[0, 1, 3]] = 0.0
        without = of(x)[0]
        s.wrench[0] = 1.0
        u_x, minus_u_y = (of(x)[0] - without)[:2]
        s.wrench[:2] = np.linalg.solve([[u_x, -minus_u_y], [minus_u_y, u_x]], -without[:2])
        s.wrench[3] = -without[2]
        e, h = of(x)
        np.testing.assert_allclose(e, 0.0, atol=1e-12)
        slopes = differences(of, x)
        for j in range(STATES):
            size = SPREADS[j] / SCALE
            np.testing.assert_allclose(h[:, j] * size, slopes[:, j] * size, rtol=1e-4, atol=1e-5)


def test_derivatives_of_the_load_after_a_fall():
    """The ellipsoid, torque about the centre: there the size of the load has closed derivatives."""
    rng, states = np.random.default_rng(2), (MU, FALLS, R, OLD, ZERO, ZERO + 1, TILT, TILT + 1)
    for _ in range(50):
        x, s = drawn(rng, FALL)
        x[[SHAPE, COP, COP + 1]] = 0.0
        h = residual(stick, x, s, P, True, 0.01)[1][0]
        slopes = differences(lambda y, s=s: residual(stick, y, s, P, True, 0.01), x)[0]
        np.testing.assert_allclose(h[list(states)], slopes[list(states)], rtol=1e-5, atol=1e-7)


def test_the_load_before_a_slip_says_nothing_of_mu_c():
    x, s = drawn(np.random.default_rng(3), BREAK)
    h = residual(stick, x, s, P, False, 0.01)[1][0]
    assert h[RATIO] == 1.0
    assert not np.delete(h, RATIO).any()


def test_states_stay_where_the_law_is_meant_for():
    x = np.full(STATES, 400.0)
    _limit(P, x)
    assert np.exp(x[[MU, R, FALLS, GROWS]]).max() < 100.0
    _limit(P, np.negative(x, out=x))
    assert np.abs(x[[FALLS, GROWS]]).max() <= 0.5
