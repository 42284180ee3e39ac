"""The covariance of "adaptive" stays symmetric bit for bit, and positive, without being made so."""

import numpy as np

import estimator


def test_covariance_stays_symmetric_and_positive_while_slips_and_loads_change():
    rng, n, steps = np.random.default_rng(0), 8, 600
    batch = estimator.make_batch("adaptive", n)
    seen = False
    for k in range(steps):
        t = k / 120.0
        spin = 2.0 * np.sin(3.0 * t + np.arange(n))
        twists = np.column_stack([0.02 * np.cos(2.0 * t + np.arange(n)), np.full(n, -0.01), spin])
        if (k // 60) % 3 == 2:
            twists[:] = 0.0  # it sticks
        f_n = 4.0 + 3.0 * np.sin(0.7 * t) * np.ones(n)
        speed = np.sqrt((twists[:, :2] ** 2).sum(1) + (0.01 * spin) ** 2) + 1e-9
        wrenches = np.empty((n, 4))
        for j in range(2):
            wrenches[:, j] = 0.6 * f_n * twists[:, j] / speed
        wrenches[:, 2], wrenches[:, 3] = f_n, 0.6 * f_n * 1e-4 * spin / speed
        batch.update(t, wrenches + rng.normal(0.0, [0.05, 0.05, 0.05, 5e-4], (n, 4)), twists)
        covariance = batch.states["covariance"]
        assert (covariance == covariance.transpose(0, 2, 1)).all()
        seen |= bool((batch.states["updates_r"] > 0).all())
    assert seen
    assert (np.linalg.eigvalsh(covariance) > -1e-12).all()
