"""The estimator "joint" in fast stick-slip: closed loop, realistic sensors, four materials."""

import numpy as np
import pytest

import policies
from slipgym.envs import LinearSlipEnv


def means_in_slip(material, estimator):
    """Mean mu_s and mu_c over both fingers' samples in slip after the first second, by their truth."""
    env = LinearSlipEnv(friction_source="estimated", material=material, estimator=estimator)
    policy, kept = policies.make("linear_slip_continuous"), []
    for seed, duration in enumerate((2.0, 5.0)):
        observation, info = env.reset(seed=seed, options={"distance": 0.04, "duration": duration})
        state, over, step = None, False, 0
        before = info["slip"]
        while not over:
            action, state = policy.predict(observation, state=state)
            observation, _, terminated, truncated, info = env.step(action)
            moved = np.hypot(*(info["slip"] - before)[:2]) > 1.5e-3 / 120
            before, step, over = info["slip"], step + 1, terminated or truncated
            if moved and step > 120:
                kept.append(info["estimated_per_finger"][:, :2] / info["true"][:2])
        assert info["is_success"]
    env.close()
    return np.mean(kept, axis=(0, 1))


@pytest.mark.parametrize("material", ["wood", "case", "plastic", "cardboard"])
@pytest.mark.quick_cases("wood")
def test_stick_slip_keeps_its_estimates_true(material):
    mu_s, mu_c = means_in_slip(material, {"name": "joint"})
    assert mu_c == pytest.approx(1.0, abs=0.03)
    assert mu_s == pytest.approx(1.0, abs=0.05)
