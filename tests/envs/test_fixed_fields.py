"""The fields that a state must share with its environment are those that the records declare as fixed."""

import numpy as np
import pytest

from slipgym.config import load
from slipgym.config.sensors import ForceTorqueConfig, SlipConfig
from slipgym.contact.records import PAD_FIXED
from slipgym.envs.state_checks import RULES
from slipgym.sensors.force_torque import FORCE_TORQUE_FIXED
from slipgym.sensors.slip_velocity import SLIP_SENSOR_FIXED
from slipgym.world.plant import build
from slipgym.world.records import FINGER_FIXED

FIXED = {
    "pads": PAD_FIXED,
    "fingers": FINGER_FIXED,
    "force_torque": FORCE_TORQUE_FIXED,
    "slip_sensors": SLIP_SENSOR_FIXED,
}


@pytest.mark.parametrize("name", FIXED)
def test_fixed_fields_are_checked_in_a_state(name):
    assert set(RULES[name].fixed) == set(FIXED[name].names)


@pytest.mark.parametrize(
    ("group", "array", "model", "units"),
    [
        ("force_torque", "force_torque", ForceTorqueConfig, set()),
        ("slip", "slip_sensors", SlipConfig, {"count", "noise"}),
    ],
)
def test_a_noise_term_reaches_the_record_by_its_name(group, array, model, units):
    """Those of other units, whose sensor counts in them, are converted by hand."""
    config = load(sensors="lab")
    fields = build(config).__dict__[array].dtype.names
    shared = [name for name in model.model_fields if name in fields and name not in units]
    assert {"dropout"} < set(shared)
    values = getattr(config.sensors, group)
    changed = {name: getattr(values, name) + 1 if name in ("chips", "window") else 0.011 for name in shared}
    sensor = build(load({"sensors": {group: changed}}, sensors="lab")).__dict__[array]
    for name in shared:
        np.testing.assert_array_equal(sensor[name], changed[name])
