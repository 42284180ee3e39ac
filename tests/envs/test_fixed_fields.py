"""A noise term of a sensor reaches its record by name."""

import numpy as np
import pytest

from slipgym.config import load
from slipgym.config.sensors import ForceTorqueConfig, SlipConfig
from slipgym.world.plant import build


@pytest.mark.parametrize(
    ("group", "array", "model", "units"),
    [
        ("force_torque", "force_torque", ForceTorqueConfig, set()),
        ("slip", "slip_sensors", SlipConfig, {"count", "noise", "rest_after", "rest_period"}),
    ],
)
def test_a_noise_term_reaches_the_record_by_its_name(group, array, model, units):
    """Those of other units, in which the sensor counts, are converted by hand."""
    config = load(sensors="lab")
    fields = build(config).__dict__[array].dtype.names
    shared = [name for name in model.model_fields if name in fields and name not in units]
    assert {"dropout"} < set(shared)
    values = getattr(config.sensors, group)
    changed = {name: getattr(values, name) + 1 if name in ("chips", "window") else 0.011 for name in shared}
    sensor = build(load({"sensors": {group: changed}}, sensors="lab")).__dict__[array]
    for name in shared:
        np.testing.assert_array_equal(sensor[name], changed[name])
