"""Many episodes that begin together are those that begin alone, and cost little."""

from time import process_time

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils import seeding

from slipgym.config.randomization import Ranges
from slipgym.envs.values import FRICTION, NAMES, labels, nominal_values
from tests.vector_checker.returned import info_of

LINEAR = "slipgym/LinearSlip-v0"
EVERYTHING = {
    "materials": ["wood", "case"],
    "pressure": ["hertz", "uniform"],
    "mass_scale": {"log_uniform": [0.7, 1.3]},
    "slip_latency": {"choices": [0, 1, 2]},
    "shear_compliance": {"uniform": [0.0, 1e-4]},
    "anisotropy": {"uniform": [-0.1, 0.1]},
    "cop_offset": {"uniform": [-5e-4, 5e-4]},
    "disturbances": [
        {
            "kind": "push",
            "probability": 0.6,
            "time": {"uniform": [0.0, 0.05]},
            "duration": {"log_uniform": [0.01, 0.1]},
            "impulse": {"uniform": [0.002, 0.01]},
            "direction": {"uniform": [-3.0, 3.0]},
            "lever": {"choices": [-0.01, 0.0, 0.01]},
        },
        {
            "kind": "shake",
            "probability": 0.6,
            "amplitude": {"uniform": [2e-4, 1e-3]},
            "pitch": {"uniform": [0.0, 0.005]},
            "frequency": {"uniform": [1.0, 3.0]},
        },
        {
            "kind": "mass_change",
            "probability": 0.6,
            "time": {"uniform": [0.0, 0.05]},
            "factor": {"uniform": [0.9, 1.1]},
        },
        {
            "kind": "friction_jump",
            "probability": 0.6,
            "time": {"uniform": [0.0, 0.05]},
            "factor": {"uniform": [0.9, 1.1]},
        },
        {
            "kind": "surface_region",
            "probability": 0.6,
            "start": {"uniform": [0.0, 0.001]},
            "length": {"uniform": [0.0, 0.01]},
            "factor": {"uniform": [0.9, 1.1]},
        },
    ],
}
"""A randomization with every kind of distribution, name and disturbance."""


def episodes(env) -> list:
    """EPISODE rows as plain data."""
    episode = env.unwrapped.simulation.episode
    columns = [episode[name].tolist() for name in episode.dtype.names]
    return list(zip(*columns, strict=True))


def test_rows_are_scalars_under_every_disturbance():
    n, options = 6, {"mu_s": 0.9}
    envs = gym.make_vec(LINEAR, num_envs=n, randomization=EVERYTHING)
    for given in (None, options):
        observations, infos = envs.reset(seed=5, options=given)
        drawn = [info_of(infos, i) for i in range(n)]
        assert len({info["drawn"]["disturbances"] for info in drawn}) > 2
        assert len({info["drawn"]["pressure"] for info in drawn}) == 2
        rows = episodes(envs)
        step = envs.step(np.full((n, 1), -0.9, dtype=np.float32))
        for i in range(n):
            env = gym.make(LINEAR, engine="planar", randomization=EVERYTHING)
            observation, info = env.reset(seed=5 + i, options=given)
            np.testing.assert_array_equal(observation, observations[i])
            assert info["drawn"] == drawn[i]["drawn"]
            assert episodes(env) == [rows[i]]
            np.testing.assert_array_equal(env.step(np.float32([-0.9]))[0], step[0][i])
            env.close()
    envs.close()


@pytest.mark.parametrize("env_id", ["slipgym/Hold-v0", "slipgym/PlanarSlip-v0"])
def test_rows_begin_alike_together_and_apart(env_id):
    n, mask = 5, np.array([True, False, True, False, False])
    together, apart = (
        gym.make_vec(env_id, num_envs=n, randomization="train", autoreset_mode="Disabled") for _ in range(2)
    )
    together.reset(seed=1)
    apart.reset(seed=1)
    together.reset()
    for some in (~mask, mask):
        apart.reset(options={"reset_mask": some})
    assert episodes(together) == episodes(apart)
    rows = [{"mu_s": 1.0}, None, {"object_mass": 0.2}, None, {}]
    together.reset(seed=2, options={"rows": rows})
    apart.reset(seed=2)
    for i in (1, 3, 4):  # those without options of their own
        assert episodes(together)[i] == episodes(apart)[i]
    together.close()
    apart.close()


@pytest.mark.parametrize("scale", [1.0, 0.25])
def test_values_are_quantiles_at_the_generators_numbers(scale):
    """Two uniform numbers for each field, or one for each of its numbers, in the order of `Ranges`."""
    env = gym.make(LINEAR, engine="planar", randomization="train")
    ranges = env.unwrapped.randomization.of("linear_slip")
    nominal = nominal_values(env.unwrapped.config)[0]
    for seed in range(5):
        _, info = env.reset(seed=seed, options={"randomization_scale": scale})
        rng = seeding.np_random(seed)[0]
        for name in Ranges.model_fields:
            field = getattr(ranges, name)
            if name == "disturbances" or field is None:
                continue
            centre = np.ravel(nominal[name]).tolist()
            shares = rng.random(max(2, len(centre)))
            if name in FRICTION + NAMES:
                continue
            for label, value, share in zip(labels(name), centre, shares, strict=False):
                expected = (1.0 - scale) * value + scale * field.at(share)
                assert info["drawn"][label] == (round(expected) if name == "slip_latency" else expected)
    env.close()


def test_a_reset_costs_few_steps():
    """Six control steps settle the grip; sampling, infos and the rest may take as long as 60 more."""
    env = gym.make_vec(LINEAR, num_envs=512, threads=1, randomization="train")
    firm = np.ones((512, 1), dtype=np.float32)

    def cost(function) -> float:
        function()
        times = []
        for _ in range(7):
            start = process_time()
            function()
            times.append(process_time() - start)
        return min(times)

    env.reset(seed=0)
    assert cost(env.reset) < 66.0 * cost(lambda: env.step(firm))
    env.close()
