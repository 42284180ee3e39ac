"""How often the truth lies within one stated deviation: exact surface data, white noise of the sensor."""

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import RATE, disc, ellipsoid, planar

MU_C, R, FINGERS = 0.4, 0.01, 400
SD_WRENCH = np.array([0.02, 0.02, 0.04, 5e-4])  # [N, N, N, N m]
SD_TWIST = np.array([1.6e-4, 1.6e-4, 6.5e-3])  # [m/s, m/s, rad/s]
SHARE, MARGIN = 0.68, 0.15
"""400 fingers show a share to 2.5 %; neighbouring samples share a velocity, which moves it more."""


def course(kind, k):
    """v_t and omega at varying speed; a spin comes after a slide, without which it shows a product only."""
    speed = 0.04 + 0.02 * np.sin(0.2 * k)
    gamma_t = {"translation": 1.0, "spin": 1.0 if k < 120 else 0.0, "planar": 0.7}[kind]
    return planar(gamma_t, R, speed)


def noisy(name, kind, surface, **parameters):
    """Estimates of many fingers after 3 s, each with noise of its own."""
    rng = np.random.default_rng(1)
    batch = estimator.make_batch(name, FINGERS, **parameters)
    for k in range(360):
        _, wrench, twist = surface(1, *course(kind, k), MU_C, R)[0]
        wrenches = wrench + SD_WRENCH * rng.standard_normal((FINGERS, 4))
        twists = twist + SD_TWIST * rng.standard_normal((FINGERS, 3))
        batch.update(k / RATE, wrenches, twists)
    return batch.estimates


def within(estimates, field, truth):
    return np.mean(np.abs(estimates[field] - truth) <= estimates[f"sd_{field}"])


@pytest.mark.parametrize(("name", "surface"), [("joint", ellipsoid), ("disc", disc)])
@pytest.mark.parametrize(
    ("kind", "fields"), [("translation", ("mu_c",)), ("spin", ("r",)), ("planar", ("mu_c", "r"))]
)
def test_deviations_are_those_of_the_noise(name, surface, kind, fields):
    e = noisy(name, kind, surface)
    for field in fields:
        assert within(e, field, {"mu_c": MU_C, "r": R}[field]) == pytest.approx(SHARE, abs=MARGIN), field


@pytest.mark.parametrize(
    ("kind", "fields"), [("translation", ("mu_c",)), ("spin", ("r",)), ("planar", ("mu_c", "r"))]
)
def test_ukf_is_on_the_safe_side(kind, fields):
    """Its deviation holds the errors of the law and the walk, which this data does not have."""
    e = noisy("ukf", kind, disc)
    for field in fields:
        assert within(e, field, {"mu_c": MU_C, "r": R}[field]) > SHARE - MARGIN, field
