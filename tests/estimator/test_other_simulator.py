"""The default estimator, made by its name alone, on records of a simulation that shares no code with it."""

from functools import cache

import numpy as np
import pytest

import estimator
from tests.estimator import lugre_world

pytestmark = pytest.mark.slow

MATERIALS = {
    "wood": (0.3623, 0.5155),
    "case": (0.4208, 0.606),
    "plastic": (0.3646, 0.5705),
    "cardboard": (0.4039, 0.5819),
}
DRAGS = {"slow": (4.0, 8e-3, 300.0, 0.2), "fast": (6.0, 0.03, 600.0, 0.3)}
COURSES = {"firm": ((8.0, 8.0), 0.03, 2.5, 1.0), "changing force": ((4.0, 12.0), 0.015, 1.0, 2.0)}
PATCHES = list(zip(MATERIALS, ["disc", "hertz"] * 2, strict=True))
LATE = {"prompt": {}, "one late": {"late": 1}, "two late": {"late": 2}, "jitter": {"jitter": 0.3}}
ALONE = {
    "zero error": {"zero": (0.15, 0.13)},
    "tilt": {"tilt": 0.035},
    "centre of pressure": {"cop": (0.0014, 0.0014)},
    "three late": {"late": 3},
}
TOGETHER = {key: value for case in ALONE.values() for key, value in case.items()} | {"jitter": 0.3}


@cache
def dragged(material, drag, kind):
    return lugre_world.stick_slip(*MATERIALS[material], *DRAGS[drag], kind)


@cache
def guided(material, course, kind):
    return lugre_world.planar(*MATERIALS[material], *COURSES[course], kind)


def estimates(trace, **sensors):
    """Times (n,) and mu_c, r (n, 2) that the default estimator publishes."""
    times, wrenches, twists = lugre_world.sense(trace, np.random.default_rng(0), **sensors)
    friction = estimator.make(estimator.DEFAULT)
    rows = [friction.update(*sample) for sample in zip(times, wrenches, twists, strict=True)]
    return times, np.array([(row.mu_c, row.r) for row in rows])


@pytest.mark.parametrize("sensors", LATE.values(), ids=LATE)
@pytest.mark.parametrize("drag", DRAGS)
@pytest.mark.parametrize(("material", "kind"), PATCHES)
def test_stick_slip_whose_velocities_are_late(material, kind, drag, sensors):
    trace = dragged(material, drag, kind)
    times, values = estimates(trace, **sensors)
    assert values[times > 3.0, 0].mean() == pytest.approx(trace.mu_c, rel=0.05)


@pytest.mark.parametrize("sensors", [{}, *ALONE.values(), TOGETHER], ids=["good", *ALONE, "together"])
@pytest.mark.parametrize("course", COURSES)
@pytest.mark.parametrize(("material", "kind"), PATCHES)
def test_planar_slip_with_errors_of_the_sensors(material, kind, course, sensors):
    trace = guided(material, course, kind)
    times, values = estimates(trace, **sensors)
    late = times > lugre_world.MOTION + 3.0
    within = 0.1 if sensors is TOGETHER else 0.06
    np.testing.assert_allclose(values[late].mean(axis=0), (trace.mu_c, trace.r), rtol=within)


@pytest.mark.parametrize("factor", [1.35, 0.7])
@pytest.mark.parametrize("material", MATERIALS)
def test_a_jump_of_friction(material, factor):
    """Both coefficients change at 4 s; the estimate is right again, and stays so, within 0.3 s."""
    trace = lugre_world.planar(*MATERIALS[material], (8.0, 8.0), jump=(4.0, factor))
    times, values = estimates(trace, late=1)
    after = values[times > 4.3, 0]
    np.testing.assert_allclose(after, factor * trace.mu_c, rtol=0.05)


@pytest.mark.parametrize(("speed", "spin"), [(6e-4, 0.3), (4e-4, 0.2), (3e-4, 0.4)])
@pytest.mark.parametrize(("material", "kind"), PATCHES)
def test_slips_slower_than_the_stribeck_velocity(material, kind, speed, spin):
    """A small pad turns slowly: friction is up to 30 % above mu_c.

    A part of 0.3 to 0.5 of it is static friction; mu_s over mu_c is expected with a deviation of 20 %.
    """
    trace = lugre_world.planar(
        *MATERIALS[material], (6.0, 6.0), speed, spin, 1.0, kind, time=8.0, radius=0.004
    )
    times, values = estimates(trace)
    assert values[times > 6.0, 0].mean() == pytest.approx(trace.mu_c, rel=0.1)


def test_the_simulation_slides_as_analysis_says():
    """A steady slide carries mu_c f_n and viscous friction; a disc's equivalent radius is 2/3 of its own."""
    trace = lugre_world.planar(0.4, 0.5, (8.0, 8.0), speed=0.02, spin=0.0, time=3.0)
    force, way = trace.wrench[2900, :2], trace.pose[2900, :2] - trace.pose[2899, :2]
    speed = np.hypot(*way) * lugre_world.FORCE_RATE
    assert np.hypot(*force) == pytest.approx(8.0 * (0.4 + lugre_world.SIGMA_2 * speed), rel=2e-3)
    assert trace.r == pytest.approx(2 / 3 * 0.012, rel=0.01)
