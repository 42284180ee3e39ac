"""Two pads whose friction differs, on either engine."""

import numpy as np
import pytest

from slipgym.validation.bench import Bench, Friction

MU, SPLIT, MASS, GRIP = 0.4, 0.25, 0.2, 2.2


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_each_pad_slides_with_its_own_friction(engine):
    with Bench(
        friction=Friction(mu_s=MU, mu_c=MU), force=20.0, size=(0.08, 0.03, 1.0), engine=engine
    ) as bench:
        for field in ("mu_s", "mu_c"):
            bench.plant.pads[field] *= [1.0 - SPLIT, 1.0 + SPLIT]
        bench.settle()
        trace = bench.run(0.3, force=lambda _: GRIP)
        wrench, pads = bench.plant.pads["wrench"][0], bench.plant.pads[0]
        speed = float(np.linalg.norm(trace.twist[-1, :2]))
        sigma_2 = bench.config.contact.sigma_2
    assert speed > 0.05
    expected = pads["normal"] * (pads["mu_c"] + sigma_2 * speed)
    assert np.linalg.norm(wrench[:, :2], axis=1) == pytest.approx(expected, rel=5e-3)
    assert pads["mu_c"] == pytest.approx([0.3, 0.5])
    assert trace.slip[-1, 2] == pytest.approx(0.0, abs=1e-9)  # equal lever, no torque
