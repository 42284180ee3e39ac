"""The merged estimate of both fingers."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from estimator import ESTIMATE
from slipgym.envs.observation import DEVIATIONS, FRICTION, combine

friction, weight = st.floats(0.01, 10.0), st.floats(0.0, 1.0)
finger = st.tuples(friction, friction, weight, weight)


def merged(*fingers):
    """Merged mu_s and mu_c of (mu_s, mu_c, confidence_mu_s, confidence_mu_c) of both fingers."""
    estimates = np.zeros(2, ESTIMATE)
    for name, values in zip(
        ("mu_s", "mu_c", "confidence_mu_s", "confidence_mu_c"), zip(*fingers, strict=True), strict=True
    ):
        estimates[name] = values
    friction = np.zeros((1, len(FRICTION) + len(DEVIATIONS)))
    combine(estimates, np.zeros((1, 2, 3)), friction)
    return friction[0, 0], friction[0, 1]


@settings(deadline=None)
@given(finger, finger)
def test_merged_mu_s_is_at_least_merged_mu_c(a, b):
    ordered = [(max(mu_s, mu_c), mu_c, *weights) for mu_s, mu_c, *weights in (a, b)]
    mu_s, mu_c = merged(*ordered)
    assert mu_s >= mu_c


def test_weights_that_would_reverse_the_order():
    assert merged((0.3, 0.2, 1.0, 0.0), (0.9, 0.8, 0.0, 1.0)) == (0.8, 0.8)
    assert merged((0.3, 0.2, 1.0, 1.0), (0.9, 0.8, 1.0, 1.0)) == pytest.approx((0.6, 0.5))


def test_the_start_value_of_mu_c_yields_to_a_measured_mu_s():
    assert merged((0.5, 0.5, 0.5, 0.0), (1.5, 1.3, 0.0, 0.0)) == (0.5, 0.5)
    assert merged((1.5, 1.3, 0.0, 0.0), (1.5, 1.3, 0.0, 0.0)) == (1.5, 1.3)
