"""The deviations that "adaptive" states, in worlds that share nothing with slipgym."""

import numpy as np
import pytest

from lab.worlds import errors
from lab.worlds.run import FIRST, UNTOUCHED, misleads

NAME = "adaptive"
WORLDS = 40

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def found():
    """Errors of what the motion shows."""
    rows = errors(FIRST, FIRST + WORLDS, [NAME], progress=False)
    return rows[rows["shown"]]


@pytest.mark.parametrize("quantity", ["mu_c", "r"])
def test_the_stated_deviation_covers_the_truth(found, quantity):
    """68 and 95 % of a normal error; 40 worlds, whose marks are not independent, scatter by 7 and 3 %."""
    rows = found[(found["quantity"] == quantity) & (found["confidence"] > UNTOUCHED)]
    ratio = (rows["error"] / rows["deviation"]).to_numpy()
    assert len(ratio) > 0.7 * WORLDS
    assert 0.55 <= np.mean(ratio <= 1.0) <= 0.9
    assert np.mean(ratio <= 2.0) >= 0.88


def test_few_estimates_mislead(found):
    """1 % of the marks of mu_c and r, 3 % of those of mu_s: 2 and 3 of about 100 and 70."""
    wrong = found[misleads(*(found[name].to_numpy() for name in ("error", "deviation", "confidence")))]
    cases = wrong[["seed", "quantity", "error", "deviation", "confidence"]].to_dict("records")
    assert sum(case["quantity"] != "mu_s" for case in cases) <= 2, cases
    assert sum(case["quantity"] == "mu_s" for case in cases) <= 3, cases
