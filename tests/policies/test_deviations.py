"""Controllers read the deviations of the estimates: a grip that holds takes a low quantile of friction."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import policies
from policies.controllers.base import Columns
from policies.controllers.hold import HoldPolicy
from policies.controllers.sensing import ConservativePrior
from slipgym.envs import HoldEnv
from slipgym.envs.observation import DEVIATION_COLUMNS, FRICTION_COLUMNS

POLICY = HoldPolicy()
NAMES = [column.name for column in (*FRICTION_COLUMNS, *DEVIATION_COLUMNS)]


def columns(shown=True, **values: Any) -> Columns:
    """Observations of Hold with these values, with or without deviations."""
    n = max(np.size(value) for value in values.values())
    row = np.zeros((n, POLICY.index[NAMES[-1]] + 1))
    for name, value in values.items():
        row[:, POLICY.index[name]] = value
    return Columns(row if shown else row[:, : -len(DEVIATION_COLUMNS)], POLICY.index)


SURE = {"confidence_mu_c": 1.0, "confidence_r": 1.0}


def test_a_grip_that_holds_takes_the_lower_quartile():
    prior = ConservativePrior()
    sd = np.array([0.0, 0.02, 0.1, 0.3, 0.6])
    found = prior.hold(columns(mu_c=0.6, sd_mu_c=sd, **SURE), "mu_c")
    # a normal number is below its mean less 0.674 deviations with a probability of one quarter
    assert found[0] == pytest.approx(0.6)
    np.testing.assert_allclose(found[:4], 0.6 * np.exp(-0.67 * sd[:4] / 0.6), rtol=1e-6)
    assert (np.diff(found) < 0.0).all()
    np.testing.assert_allclose(prior.blend(columns(mu_c=0.6, sd_mu_c=sd, **SURE), "mu_c"), 0.6, rtol=1e-6)


def test_it_is_never_more_cautious_than_the_prior():
    prior = ConservativePrior(mu_c=0.3)
    for mu_c, least in ((0.6, 0.3), (0.35, 0.3), (0.2, 0.2)):
        sd = np.linspace(0.0, 10.0, 50)
        found = prior.hold(columns(mu_c=mu_c, sd_mu_c=sd, **SURE), "mu_c")
        assert found.min() == pytest.approx(least)


def test_without_deviations_it_takes_the_estimate():
    prior = ConservativePrior()
    seen = columns(False, mu_c=0.6, r=0.01, **SURE)
    assert prior.hold(seen, "mu_c") == prior.blend(seen, "mu_c") == pytest.approx(0.6)
    assert prior.hold_lever(seen) == prior.blend_lever(seen)


def test_the_product_of_a_spin_counts_where_its_factors_are_unknown():
    prior, doubt = ConservativePrior(), {"confidence_mu_c": 0.01, "confidence_r": 0.01}
    known = columns(mu_c=0.6, r=0.012, sd_mu_c=0.4, sd_r=0.01, sd_lever=1e-4, **doubt)
    unknown = columns(mu_c=0.6, r=0.012, sd_mu_c=0.4, sd_r=0.01, sd_lever=0.007, **doubt)
    assert prior.blend_lever(known) == pytest.approx(0.6 * 0.012)
    assert prior.blend_lever(unknown) < 0.5 * 0.6 * 0.012
    assert prior.hold_lever(known) == pytest.approx(0.6 * 0.012 * np.exp(-0.67 * 1e-4 / 0.0072))


@pytest.mark.parametrize("bad", [-0.1, np.inf, np.nan])
def test_bad_deviations_are_named(bad):
    with pytest.raises(ValueError, match="deviations"):
        ConservativePrior(deviations=bad)


@pytest.mark.parametrize("source", ["estimated", "true", "nominal"])
def test_the_environment_shows_what_the_estimators_state(source):
    env = HoldEnv(observation_mode="deviations", friction_source=source, estimator="adaptive")
    plain = HoldEnv(friction_source=source, estimator="adaptive")
    observation, _ = env.reset(seed=0)
    without, _ = plain.reset(seed=0)
    for _ in range(60):
        observation, *_ = env.step(np.array([-0.9], np.float32))
        without, *_ = plain.step(np.array([-0.9], np.float32))
    assert [column.name for column in env.columns][-len(NAMES) :] == NAMES
    np.testing.assert_array_equal(observation[: -len(DEVIATION_COLUMNS)], without)
    stated = env.simulation.estimator.estimates
    shown = dict(zip(NAMES, observation[-len(NAMES) :], strict=True))
    env.close()
    plain.close()
    for name in ("mu_s", "mu_c", "r", "lever"):
        low, high = np.sort(stated[f"sd_{name}"])
        value = shown[f"sd_{name}"]
        assert low * (1 - 1e-6) <= value <= high * (1 + 1e-6) if source == "estimated" else value == 0.0


@pytest.mark.parametrize(
    "name",
    [
        *("hold", "fragile_hold", "carry", "linear_slip", "planar_slip", "rotational_slip", "hinge"),
        *("explore", "pivot_to"),
    ],
)
def test_controllers_ask_for_them(name):
    policy = policies.make(name)
    env = gym.make(f"slipgym:slipgym/{policy.task}-v0", engine="planar", **policies.modes(policy))
    observation, _ = env.reset(seed=0)
    env.close()
    assert observation.shape == (policy.index[NAMES[-1]] + 1,)
    policy.predict(observation)
