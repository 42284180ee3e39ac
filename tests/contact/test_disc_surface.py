"""The disc: its table against the exact surface, its projection against a search, its coupled step."""

import math

import numpy as np
import pytest

from estimator.limit_surface import DISC_RADIUS, disc_friction
from lab.limit_surface_exact import exact_friction
from slipgym.contact import DiscContact
from slipgym.contact.coupled import assemble, norm, set_friction_level, solve_motion
from slipgym.contact.disc_surface import INNER, project, support
from slipgym.contact.records import DISC, pads
from slipgym.contact.soft_pad import load_pad

CURVE = np.array(
    [(h + (1.0 - s) * d, h - s * d) for s in np.linspace(0, 1, 4001) for h, d, _ in [support(s)]]
)


def test_the_table_is_the_exact_surface():
    rng = np.random.default_rng(0)
    for s in rng.uniform(0.0, 1.0, 500):
        h, slope, bend = support(s)
        force, torque = disc_friction(DISC_RADIUS * s / (1.0 - s))
        assert h + (1.0 - s) * slope == pytest.approx(force, abs=5e-6)
        assert h - s * slope == pytest.approx(torque / DISC_RADIUS, abs=5e-6)
        assert bend > 0.0  # convex
    assert np.hypot(*CURVE.T).min() > INNER


def test_a_projection_is_the_closest_point_and_its_derivative():
    rng = np.random.default_rng(1)
    size, step = 0.8, 1e-6
    for _ in range(50):
        y = rng.normal(size=3)
        y *= rng.uniform(1.0, 3.0) / np.linalg.norm(y)
        point, slope, _ = project(tuple(y), size, rng.uniform())
        away = np.hypot(*(size * CURVE - [math.hypot(y[0], y[1]), abs(y[2])]).T)
        assert np.linalg.norm(np.array(point) - y) == pytest.approx(away.min(), abs=1e-6)
        xx, yy, tt, xy, xt, yt = slope
        columns = [
            (
                np.array(project(tuple(y + step * e), size, 0.5)[0])
                - project(tuple(y - step * e), size, 0.5)[0]
            )
            / (2.0 * step)
            for e in np.eye(3)
        ]
        np.testing.assert_allclose(columns, [[xx, xy, xt], [xy, yy, yt], [xt, yt, tt]], atol=1e-7)


def test_what_lies_within_stays():
    point, slope, place = project((0.3, 0.2, -0.4), 1.0, 0.5)
    assert point == (0.3, 0.2, -0.4)
    assert slope == (1.0, 1.0, 1.0, 0.0, 0.0, 0.0)
    assert place < 0.0


@pytest.mark.parametrize("angle", np.linspace(0.0, 0.5 * math.pi, 9))
def test_steady_slip_has_the_friction_of_the_exact_disc(angle):
    contact = DiscContact(r=0.01, mu_c=0.4, mu_s=0.5, sigma_2=0.0)
    speed = 0.03
    twist = speed * math.cos(angle) * 0.6, speed * math.cos(angle) * 0.8, speed * math.sin(angle) / 0.01
    for _ in range(400):
        f_x, f_y, tau = contact.step(twist, 5.0, 1e-4)
    expected = 2.0 * exact_friction("uniform", [(twist[0], twist[1], 0.015 * twist[2])])[0]
    np.testing.assert_allclose([f_x, f_y, tau / 0.015], expected, atol=2e-5)


def test_momentum_is_balanced_however_far_the_guess():
    rng, h = np.random.default_rng(2), 2.5e-4
    for _ in range(300):
        array = pads(
            2, stribeck_velocity=1e-3, sigma_0=10 ** rng.uniform(5.3, 6.7), sigma_1=80.0, sigma_2=0.2
        )
        array["surface"], array["r"] = DISC, rng.uniform(0.004, 0.01)
        array["mu_c"] = rng.uniform(0.2, 0.8)
        array["mu_s"] = array["mu_c"] * rng.uniform(1.0, 1.9)
        array["compliance"] = rng.choice([0.0, 5e-5])
        normal = rng.uniform(1.0, 25.0)
        for pad in array:
            load_pad(pad, normal)
        held = 2.0 * float(array["mu_s"][0]) * normal
        load = rng.normal(size=3)
        mass, arm = rng.uniform(0.05, 0.4), np.array([1.0, 1.0, array["r"][0]])
        inertia = mass, 1e-3 * mass
        size = h**2 * rng.uniform(0.0, 3.0) * held / np.linalg.norm(load)
        free = tuple(size * load * arm / [mass, mass, inertia[1]])
        cells = np.zeros((2, 0))
        limits = tuple(set_friction_level(one, cells, 0, h) for one in array)
        motion = solve_motion(array, cells, limits, inertia, (0.0, 0.0), free, free, h)
        residual, _ = assemble(array, cells, limits, inertia, (0.0, 0.0), free, motion, h)
        assert norm(residual, float(array["r"][0])) <= 1e-8 * held
