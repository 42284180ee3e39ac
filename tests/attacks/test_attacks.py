"""Wrong values and damaged files, drawn at random, are accepted or refused by a named error."""

import zlib

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
from tests.attacks import arguments, crafted

ATTACKS = {each.name: each for each in (*arguments.ATTACKS, *crafted.ATTACKS)}
SEED = 2024


def outcomes(name: str, first: int, last: int) -> dict[int, str]:
    """Outcomes that nothing explains, of the cases from `first` up to `last`."""
    attack, found = ATTACKS[name], {}
    for k in range(first, last):
        rng = np.random.default_rng([SEED, zlib.crc32(name.encode()), k])
        try:
            found[k] = attack.case(rng)
        except Exception as error:
            found[k] = f"unexplained: {type(error).__name__}: {str(error).partition(chr(10))[0]:.150}"
    return {k: each for k, each in found.items() if each not in attack.allowed}


COMPILED = "keywords", "randomization"
"""They compile every kind of pad and sensor."""
CASES = [pytest.param(name, marks=[pytest.mark.slow] * (name in COMPILED)) for name in ATTACKS]


@pytest.mark.parametrize("name", CASES)
def test_every_outcome_is_explained(name):
    assert outcomes(name, 0, ATTACKS[name].count) == {}


@pytest.mark.slow
@pytest.mark.parametrize("name", ATTACKS)
def test_every_outcome_of_more_cases_is_explained(name):
    assert outcomes(name, ATTACKS[name].count, 10 * ATTACKS[name].count) == {}
