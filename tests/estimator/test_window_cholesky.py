"""Factor and substitution of the normal equations against numpy."""

import numpy as np

from estimator.window.fit import factor, substitute
from estimator.window.layout import STATES


def test_they_are_those_of_numpy():
    rng = np.random.default_rng(0)
    for _ in range(10):
        root, g = rng.normal(size=(STATES, 2 * STATES)), rng.normal(size=STATES)
        full = root @ root.T
        a, x = full.copy(), g.copy()
        assert factor(a)
        np.testing.assert_allclose(np.tril(a), np.linalg.cholesky(full), atol=1e-12)
        substitute(a, x)
        np.testing.assert_allclose(full @ x, g, atol=1e-9)


def test_a_matrix_that_is_not_positive_has_none():
    a = np.eye(STATES)
    a[3, 3] = -1.0
    assert not factor(a)
