"""The measurement model of "adaptive": against the limit surfaces, its own differences, and rigid shifts."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import estimator
from estimator.augmented.parameters import AdaptiveParameters
from estimator.augmented.slip_law import COP, MU, SHAPE, SIGMA, STATES, TILT, ZERO, R, predict, surface
from estimator.augmented.stribeck import static_friction
from estimator.limit_surface import slip_friction

P = AdaptiveParameters().as_array().view(np.recarray)[0]
STATIC = math.log(1.4) + 0.5 * math.log(0.5), 0.5, 0.01
"""As of `static_friction`: mu_s is 0.7 at a mu_c of 0.5, and follows it with the exponent one half."""

states = st.tuples(
    st.floats(-1.6, 0.5),
    st.floats(-5.8, -4.2),
    st.floats(0.0, 0.3),
    *[st.floats(-0.3, 0.3)] * 2,
    *[st.floats(-0.05, 0.05)] * 2,
    *[st.floats(-3.0, 3.0)] * 2,
    st.floats(-0.3, 1.0),
    st.floats(0.0, 0.5),
    st.floats(0.0, 0.3),
)
twists = st.tuples(st.floats(0.004, 0.05), st.floats(-0.05, 0.05), st.floats(-3.0, 3.0))
slow_states = st.tuples(
    st.floats(-1.6, -0.1),
    st.floats(-5.8, -4.8),
    st.floats(0.0, 0.3),
    *[st.just(0.0)] * 4,
    *[st.floats(-0.3, 0.3)] * 2,
    st.floats(-0.3, 1.0),
    *[st.just(0.0)] * 2,
)
slow_twists = st.tuples(st.floats(4e-4, 2e-3), st.floats(-1e-3, 1e-3), st.floats(-0.2, 0.2))


def predicted(x, twist, f_n=5.0, sign=1.0):
    by_state, by_twist = np.zeros((3, STATES)), np.zeros((3, 3))
    static, seen, _ = STATIC
    wrench = predict(P, np.array(x, float), static, seen, sign, f_n, *twist, by_state, by_twist)
    return np.array(wrench[:3]), by_state, by_twist


def ideal(mu_c=0.4, r=0.008, sigma_2=0.0, shape=0.0):
    x = np.zeros(STATES)
    x[MU], x[R], x[SIGMA], x[SHAPE] = np.log(mu_c), np.log(r), sigma_2, shape
    return x


@pytest.mark.parametrize("disc", [True, False])
@pytest.mark.parametrize("gamma_t", [0.05, 0.3, 0.6, 0.7, 0.9, 0.999])
def test_it_is_the_limit_surface(disc, gamma_t):
    """The table's knots are 1 / 512 apart: linear interpolation is off by up to 1e-4."""
    v_t, omega, r = 0.02 * gamma_t, 0.02 * np.sqrt(1 - gamma_t**2) / 0.008, 0.008
    force, torque = slip_friction(disc, v_t, r * omega)
    (f_x, f_y, tau), _, _ = predicted(ideal(shape=0.0 if disc else 1.0), (0.0, v_t, omega))
    assert f_x == 0.0
    assert f_y == pytest.approx(0.4 * 5.0 * force, rel=3e-4)
    assert tau == pytest.approx(0.4 * 5.0 * r * torque, rel=3e-4)


def test_viscosity_adds_speed_and_the_mean_squared_radius():
    dry, _, _ = predicted(ideal(), (0.01, 0.02, 1.5))
    wet, _, _ = predicted(ideal(sigma_2=0.2), (0.01, 0.02, 1.5))
    np.testing.assert_allclose(wet - dry, 5.0 * 0.2 * np.array([0.01, 0.02, 0.5 * 0.012**2 * 1.5]), rtol=1e-9)


def test_zero_error_tilt_and_sign():
    x = ideal()
    plain, _, _ = predicted(x, (0.02, 0.0, 1.0))
    x[ZERO], x[TILT + 1] = 0.1, 0.02
    shifted, _, _ = predicted(x, (0.02, 0.0, 1.0))
    np.testing.assert_allclose(shifted - plain, (0.1, 5.0 * 0.02, 0.0), atol=1e-15)
    np.testing.assert_allclose(predicted(ideal(), (0.02, 0.0, 1.0), sign=-1.0)[0], -plain)


def test_an_offset_of_the_centre_of_pressure_is_a_shift_of_the_frame():
    """A slip seen from 2 mm beside the centre of pressure, and the torque about that point."""
    at, twist = np.array([0.002, -0.001]), np.array([0.01, 0.005, 1.5])
    true, _, _ = predicted(ideal(), twist)
    seen = twist + np.array([twist[2] * at[1], -twist[2] * at[0], 0.0])
    x = ideal()
    x[COP : COP + 2] = 1e3 * at
    found, _, _ = predicted(x, seen)
    np.testing.assert_allclose(found[:2], true[:2], rtol=1e-12)
    assert found[2] == pytest.approx(true[2] + at[0] * true[1] - at[1] * true[0], rel=1e-12)


def assert_derivatives(x, twist, steps, twist_steps, relative, absolute):
    """Central differences by some states and by the twist, in units of the largest force and torque.

    Args:
        x: States.
        twist: v_x, v_y, omega.
        steps: State -> step.
        twist_steps: Steps of the twist.
        relative: Largest error of a slope by a state, over the largest slope or 1.
        absolute: Largest error of a change by a step of the twist.
    """
    _, by_state, by_twist = predicted(x, twist)
    scale = np.array([1.0, 1.0, 0.01]) * 5.0 * np.exp(x[MU])
    for j, size in steps.items():
        step = size * np.eye(STATES)[j]
        slope = (predicted(x + step, twist)[0] - predicted(x - step, twist)[0]) / (2 * size)
        most = relative * max(1.0, np.abs(slope / scale).max())
        assert np.abs((slope - by_state[:, j]) / scale).max() < most
    for j, size in enumerate(twist_steps):
        step = size * np.eye(3)[j]
        change = (predicted(x, twist + step)[0] - predicted(x, twist - step)[0]) / 2
        assert np.abs((change - by_twist[:, j] * size) / scale).max() < absolute


@settings(deadline=None, max_examples=60)
@given(states, twists)
def test_derivatives(x, twist):
    """Across knots of the table, whose slope is piecewise linear: 2 % of the largest.

    The exponents of the load do not enter at the load of the states.
    """
    steps = {j: 1e-2 if j in (MU, R, SHAPE) else 1e-3 for j in range(STATES)}
    assert_derivatives(x, twist, steps, (1e-4, 1e-4, 1e-2), 0.02, 2e-3)


def test_the_shape_interpolates_between_disc_and_ellipsoid():
    phi, _, psi, _, to_phi, to_psi = surface(0.4, 0.0)
    assert (phi + to_phi, psi + to_psi) == (1.0, 1.0)


@pytest.mark.parametrize("speed", [0.0002, 0.0005, 0.001, 0.002, 0.005])
def test_a_slow_slip_has_a_part_of_static_friction(speed):
    """mu_c + (mu_s - mu_c) exp(-(w / v_s)^2), with v_s of 1 mm/s."""
    mu_s = math.exp(STATIC[0] + (1.0 - STATIC[1]) * math.log(0.4))
    level = 0.4 + (mu_s - 0.4) * math.exp(-((speed / 1e-3) ** 2))
    found, _, _ = predicted(ideal(), (speed, 0.0, 0.0))
    assert found[0] == pytest.approx(5.0 * level, rel=1e-6)


@settings(deadline=None, max_examples=60)
@given(slow_states, slow_twists)
def test_derivatives_of_slow_slips(x, twist):
    """As above; the law is curved within a fraction of v_s, so the steps are a hundredth of it."""
    steps = dict.fromkeys((MU, R, SIGMA, COP, COP + 1, SHAPE), 1e-3)
    assert_derivatives(x, twist, steps, (1e-5, 1e-5, 1e-3), 0.03, 1e-3)


def test_static_friction_is_that_of_the_break_aways_as_far_as_it_is_known():
    batch = estimator.make_batch("adaptive", 1)
    state = batch.states.view(np.recarray)[0]
    ratio = math.log(P.mu_s0 / P.mu_c0)
    assert static_friction(state, P) == pytest.approx((ratio, 0.0, P.sd_log_ratio**2))
    state.events_mu_s, state.mu_s, state.sd_mu_s = 3, 0.6, 0.6e-6
    assert static_friction(state, P) == pytest.approx((math.log(0.6), 1.0, 0.0), abs=1e-9)
    state.sd_mu_s = 0.6 * P.sd_log_ratio
    assert static_friction(state, P) == pytest.approx(
        (0.5 * (math.log(0.6) + ratio), 0.5, 0.5 * P.sd_log_ratio**2)
    )
