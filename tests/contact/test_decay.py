"""The exponential of the friction level against an exact one."""

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest

from slipgym._numba.compiled import compiled
from slipgym.contact import DistributedContact
from slipgym.contact.decay import decay

RNG = np.random.default_rng(8)
POWERS = np.concatenate([RNG.uniform(0.0, 40.0, 2000), 10.0 ** RNG.uniform(-20.0, 1.6, 1000)])


@compiled
def decays(powers):
    result = np.empty_like(powers)
    for i in range(powers.shape[0]):
        result[i] = decay(powers[i])
    return result


def test_accuracy():
    worst = 0.0
    with localcontext(prec=40):
        for power, found in zip(POWERS.tolist(), decays(POWERS).tolist(), strict=True):
            exact = (-Decimal(power)).exp()
            worst = max(worst, abs(float((Decimal(found) - exact) / Decimal(math.ulp(float(exact))))))
    assert worst < 1.5


def test_one_at_a_time_gives_the_same_bits():
    np.testing.assert_array_equal(decays(POWERS), [decay(power) for power in POWERS])


@pytest.mark.parametrize(("power", "expected"), [(0.0, 1.0), (40.0, 0.0), (1e300, 0.0), (math.inf, 0.0)])
def test_the_ends(power, expected):
    assert decay(power) == expected


@pytest.mark.parametrize("exponent", [0.7, 2.0, 3.0])
@pytest.mark.parametrize("speed", [0.0005, 0.002, 0.02])
def test_a_patch_slides_at_the_level_of_any_exponent(exponent, speed):
    contact = DistributedContact(cells=7, stribeck_exponent=exponent)
    for _ in range(50):
        force = contact.step((speed, 0.0, 0.0), 5.0, 1e-4)
    level = 0.4 + 0.15 * math.exp(-((speed / 1e-3) ** exponent)) + 0.2 * speed
    assert force == pytest.approx((-5.0 * level, 0.0, 0.0), rel=1e-12, abs=1e-12)
