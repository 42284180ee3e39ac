"""Force/torque samples come at their own rate, on the world's clock."""

import numpy as np
import pytest

from slipgym.sensors.force_torque import HISTORY
from slipgym.validation.bench import Bench


@pytest.mark.parametrize("rate", [500, 1000, 2000])
def test_force_torque_samples_at_its_own_rate(rate):
    with Bench({"sensors": {"force_torque": {"rate": rate}}}) as bench:
        for step in range(1, 121):
            bench.run(bench.step_time)
            sensor = bench.plant.force_torque[0, 0]
            # samples at k / rate: 25, 50, 75 of 1000 Hz fall on every third control step, not 8 1/3 on each
            newest = (step * rate // 120) % sensor["kept"]
            assert sensor["history"][newest, 2] != 0.0
            sensor["history"][:, 2] = 0.0
            assert bench.plant.world["tick"][0] * bench.plant.world["tick_length"][0] == pytest.approx(
                step / 120
            )


def test_samples_show_the_force_loop_between_engine_steps():
    latest = (HISTORY - 2) / 1000  # a sensor this late keeps all that it can
    with Bench({"sensors": {"force_torque": {"latency": latest}}}, force=5.0) as bench:
        bench.settle()
        start = int(bench.plant.world["tick"][0]) // 12
        bench.run(0.06, force=lambda _: 12.0)  # 60 samples; the sensor keeps 64
        sensor = bench.plant.force_torque[0, 0]
        numbers = np.arange(start, int(bench.plant.world["tick"][0]) // 12) + 1
        values = sensor["history"][numbers % HISTORY, 2]
    t = numbers / 1000 - 0.25
    lagged = np.where(t < 0.004, 5.0, 12.0 - 7.0 * np.exp(-(t - 0.004) / 0.012))
    # engine steps of 2 ms give the mean force only; the actuator's change since is added. What is left is the
    # engine's own residual: the normal force follows the fingers' effort to 1e-3 while it changes
    np.testing.assert_allclose(values, lagged, rtol=1e-2)
