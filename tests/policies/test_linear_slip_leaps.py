"""LinearSlip in leaps: solved however late the slip velocity is, which the controller is not given."""

import numpy as np
import pytest

import policies
from policies.controllers.linear_slip_leaps import LinearSlipLeapPolicy
from slipgym.config import load

LINEAR = "slipgym/LinearSlip-v0"
COUNTED = {"sensors": {"slip": {"scale_error": 0.0}}}
"""Sensors that count distances without an error of scale."""


def test_it_holds_before_the_reference_moves():
    policy = LinearSlipLeapPolicy()
    n = 3
    columns = policy.index
    observations = np.zeros((n, len(columns._at)))
    for finger in (1, 2):
        observations[:, columns[f"f_y_{finger}"]], observations[:, columns[f"f_n_{finger}"]] = 1.0, 15.0
    action, state = policy.predict(observations)
    memory = np.asarray(state)
    assert memory.shape == policy.initial_state(n).shape
    assert (memory[:, 0] == 0.0).all()
    least = load().gripper.force_min
    assert (action > 2.0 * (1.0 / 0.4 - least) / (load().gripper.force_max - least) - 1.0).all()


@pytest.mark.slow
@pytest.mark.parametrize("latency", [0, 2, 4])
def test_it_is_solved_however_late_the_velocity_is(latency, play_batch):
    late = {"randomization": {"slip_latency": {"choices": [latency]}}, "friction_source": "estimated"}
    assert play_batch(LINEAR, policies.make("linear_slip_leaps"), 200, 40_000, **late).success >= 0.97
    if latency == 4:
        assert play_batch(LINEAR, policies.make("linear_slip_continuous"), 100, 40_000, **late).success < 0.7


@pytest.mark.slow
@pytest.mark.parametrize("source", ["estimated", "true"])
def test_what_sensors_of_a_laboratory_cost_is_the_error_of_scale(source, play_batch):
    made = policies.make("linear_slip_leaps")
    lab = {"sensors": "lab", "friction_source": source}
    assert play_batch(LINEAR, made, 400, 40_000, **lab).success <= 0.98
    assert play_batch(LINEAR, made, 200, 40_000, **lab, config=COUNTED).success >= 0.99
