import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slipgym.contact import EllipsoidContact
from slipgym.contact.records import pads
from slipgym.contact.soft_kernel import prescribed_step

DT = 1 / 480
PARAMETERS = dict(r=0.012, mu_c=0.4, mu_s=0.55, stribeck_velocity=1e-3)  # noqa: C408


def twist_at(gamma_angle: float, azimuth: float, speed: float, r: float) -> np.ndarray:
    """Twist of a scaled speed, from translation (0) to rotation (pi/2)."""
    v_t = speed * math.cos(gamma_angle)
    return np.array([v_t * math.cos(azimuth), v_t * math.sin(azimuth), speed * math.sin(gamma_angle) / r])


@pytest.mark.parametrize("angle", np.linspace(-math.pi / 2, math.pi / 2, 9))
@pytest.mark.parametrize("sigma_2", [0.0, 0.2])
def test_steady_slip_lies_on_the_ellipsoid(angle, sigma_2):
    contact = EllipsoidContact(**PARAMETERS, sigma_2=sigma_2)
    speed, normal = 0.02, 5.0
    twist = twist_at(angle, 0.7, speed, contact.effective_radius)
    for _ in range(20):
        wrench = contact.step(twist, normal, DT)
    level = 0.4 + sigma_2 * speed  # the Stribeck part is exp(-400)
    expected = -level * normal * np.array([*twist[:2], 0.012**2 * twist[2]]) / speed
    np.testing.assert_allclose(wrench, expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("angle", [0.0, 0.5, 1.0, math.pi / 2])
def test_break_away_at_the_static_limit(angle):
    contact = EllipsoidContact(**PARAMETERS)
    r = contact.effective_radius
    twist = twist_at(angle, 2.0, 1e-6, r)  # v / v_s = 1e-3: the level is mu_s to 1e-6
    peak = 0.0
    for _ in range(1000):
        f_x, f_y, tau = contact.step(twist, 3.0, DT)
        peak = max(peak, math.hypot(f_x, f_y, tau / r))
    # sigma_1 and sigma_2 add 80.2 s/m * 1e-6 m/s = 8e-5 to 0.55
    assert peak == pytest.approx(0.55 * 3.0, rel=2e-4)


@pytest.mark.parametrize("step", [0.1, 0.5, 0.9])
def test_below_the_limit_it_is_a_spring_and_returns(step):
    contact = EllipsoidContact(**PARAMETERS, sigma_1=0.0, sigma_2=0.0)
    reach = 0.55 / 1e6 * step
    for sign in (1.0, -1.0):
        f_x, _, _ = contact.step((sign * reach / DT, 0.0, 0.0), 2.0, DT)
    assert f_x == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(contact.bristles, 0.0, atol=1e-20)


@settings(deadline=None, max_examples=50)
@given(
    sigma_0=st.sampled_from([1e5, 1e6, 1e8]),
    dt=st.sampled_from([1e-5, DT, 0.1]),
    seed=st.integers(0, 1000),
)
def test_stable_and_bounded_at_any_stiffness_and_step(sigma_0, dt, seed):
    sigma_1, sigma_2, normal = 80.0, 0.2, 7.0
    contact = EllipsoidContact(**PARAMETERS, sigma_0=sigma_0, sigma_1=sigma_1, sigma_2=sigma_2)
    rng = np.random.default_rng(seed)
    r = contact.effective_radius
    for _ in range(200):
        u = rng.normal(size=3) * 10.0 ** rng.uniform(-6, 1)
        f_x, f_y, tau = contact.step((u[0], u[1], u[2] / r), normal, dt)
        # |sigma_0 z| <= mu_s, |dz| <= min(2 mu_s / sigma_0, |u| dt), and viscous friction
        speed = np.linalg.norm(u)
        damping = sigma_1 * min(2 * 0.55 / sigma_0 / dt, speed)
        bound = normal * (0.55 + damping + sigma_2 * speed)
        assert math.hypot(f_x, f_y, tau / r) <= bound * (1 + 1e-9)


@settings(deadline=None, max_examples=100)
@given(
    sigma_0=st.sampled_from([1e5, 1e6]),
    dt=st.sampled_from([1e-6, 2.5e-4, DT]),
    sigma_1=st.sampled_from([0.0, 80.0, 1000.0]),
    spread=st.floats(0.0, 5.0),
    seed=st.integers(0, 1000),
)
def test_friction_takes_at_least_the_energy_that_it_stores(sigma_0, dt, sigma_1, spread, seed):
    contact = EllipsoidContact(**PARAMETERS, sigma_0=sigma_0, sigma_1=sigma_1)
    rng, normal = np.random.default_rng(seed), 4.0
    r, stored = contact.effective_radius, 0.0
    for _ in range(200):
        u = rng.normal(size=3) * 10.0 ** (rng.uniform(-spread, spread) - 3.0)
        f_x, f_y, tau = contact.step((u[0], u[1], u[2] / r), normal, dt)
        taken = -dt * (f_x * u[0] + f_y * u[1] + tau * u[2] / r)
        before, stored = stored, 0.5 * normal * sigma_0 * np.sum(contact.bristles**2)
        # rounding of the products
        assert taken >= stored - before - 1e-12 * (abs(taken) + stored)


def test_without_normal_force_there_is_no_friction_and_no_memory():
    contact = EllipsoidContact()
    contact.step((0.01, 0.0, 0.0), 5.0, DT)
    assert contact.step((0.01, 0.0, 0.0), 0.0, DT) == (0.0, 0.0, 0.0)
    np.testing.assert_array_equal(contact.bristles, 0.0)


def test_reset_forgets_everything():
    used, fresh = EllipsoidContact(), EllipsoidContact()
    for _ in range(5):
        used.step((0.01, -0.02, 1.0), 5.0, DT)
    used.reset()
    for _ in range(5):
        assert used.step((1e-5, 0.0, 0.01), 3.0, DT) == fresh.step((1e-5, 0.0, 0.01), 3.0, DT)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        *[(name, value) for name in ("r", "mu_c", "stribeck_velocity", "sigma_0") for value in (0.0, -1.0)],
        *[(name, -0.1) for name in ("sigma_1", "sigma_2")],
        *[(name, math.nan) for name in ("r", "mu_c", "mu_s", "sigma_0", "sigma_1", "sigma_2")],
        ("sigma_0", math.inf),
        ("mu_s", 0.39),  # below mu_c
    ],
)
def test_bad_parameters_are_named(name, value):
    with pytest.raises(ValueError, match=name):
        EllipsoidContact(**{name: value})


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (((0.0, 0.0), 1.0, DT), "twist"),
        (((0.0, math.nan, 0.0), 1.0, DT), "twist"),
        (((0.0, 0.0, 0.0), -1.0, DT), "normal_force"),
        (((0.0, 0.0, 0.0), math.inf, DT), "normal_force"),
        (((0.0, 0.0, 0.0), 1.0, 0.0), "dt"),
    ],
)
def test_bad_arguments_are_named_and_change_nothing(arguments, name):
    contact = EllipsoidContact()
    contact.step((1e-5, 0.0, 0.0), 2.0, DT)
    before = contact.bristles
    with pytest.raises(ValueError, match=name):
        contact.step(*arguments)
    np.testing.assert_array_equal(contact.bristles, before)


def test_the_friction_level_is_that_of_the_middle_of_a_step_however_uneven_steps_are():
    """Slip that gains 0.5 m/s^2: the speed of every step is known from those before."""
    law = {"mu_c": 0.4, "mu_s": 0.6, "stribeck_velocity": 1e-3, "sigma_1": 80.0, "sigma_2": 0.2}
    contact, time, normal = EllipsoidContact(r=0.01, sigma_0=1e6, **law), 2e-3, 2.0
    for k, dt in enumerate([3e-4, 1e-4, 1e-4, 3e-4, 2e-4, 1e-4, 3e-4, 1e-4]):
        speed = 0.5 * (time + 0.5 * dt)
        time += dt
        f_x, _, _ = contact.step((speed, 0.0, 0.0), normal, dt)
        level = 0.4 + 0.2 * math.exp(-((speed / 1e-3) ** 2)) + 0.2 * speed
        if k > 5:  # by then it has slipped for three steps
            assert f_x == pytest.approx(-normal * level, rel=1e-9)


def test_what_anisotropy_does_to_viscous_friction():
    """Axes 1 ± a stretch the slip before friction and the force after it: sigma_2 grows by (1 ± a)^2."""
    slopes = {}
    for axis, name in enumerate("xy"):
        forces = []
        for speed in (0.05, 0.15):
            pad = pads(1, mu_c=0.4, mu_s=0.4, sigma_0=1e6, sigma_2=0.2, r=0.01, stribeck_velocity=1e-3)
            pad["axes"], pad["normal"] = (1.1, 0.9), 5.0
            velocity = speed * np.eye(3)[axis]
            for _ in range(20):
                prescribed_step(pad[0], velocity, 2e-6 / speed)
            forces.append(-pad["wrench"][0, axis] / 5.0)
        slopes[name] = (forces[1] - forces[0]) / 0.1
    print({name: round(slope / 0.2, 3) for name, slope in slopes.items()})
    assert slopes["x"] / 0.2 == pytest.approx(1.21, rel=1e-6)
    assert slopes["y"] / 0.2 == pytest.approx(0.81, rel=1e-6)
