"""Pads of rubber in an environment: what an episode draws, what is published as true, rows of a batch."""

import gymnasium as gym
import numpy as np
import pytest

from slipgym.config import load_randomization
from slipgym.config.pad import EFFECTS

LINEAR = "slipgym/LinearSlip-v0"


@pytest.mark.parametrize("preset", ["lab", "eval_ood"])
def test_presets_draw_what_the_rubber_does(preset):
    ranges = load_randomization(preset)
    for name in EFFECTS:
        low, high = getattr(ranges, name).ends
        assert high > low
    train = load_randomization("train")
    assert all(getattr(train, name) is None for name in EFFECTS)


def test_an_episode_has_the_pads_that_it_drew():
    env = gym.make(f"slipgym:{LINEAR}", randomization="lab", engine="planar", disable_env_checker=True)
    _, info = env.reset(seed=3)
    pads = env.unwrapped.simulation.plant.pads[0]
    drawn = info["drawn"]
    for name in ("load_exponent", "radius_exponent", "cop_lever", "creep", "aging"):
        assert pads[name] == pytest.approx(drawn[name])
    assert pads["compliance"] == pytest.approx(drawn["shear_compliance"])
    assert pads["axes"][0] == pytest.approx([1.0 + drawn["anisotropy"], 1.0 - drawn["anisotropy"]])
    env.reset(seed=3, options={"randomization_scale": 0.0})
    assert pads["load_exponent"] == pytest.approx(0.0)
    assert pads["axes"] == pytest.approx(1.0)
    env.close()


def test_true_friction_is_that_of_the_present_load():
    pad = {"load_exponent": 0.3, "radius_exponent": 0.2, "reference_force": 5.0}
    config = {"contact": {"pad": pad}}
    env = gym.make(f"slipgym:{LINEAR}", config=config, engine="planar", disable_env_checker=True)
    env.reset(seed=0, options={"mu_c": 0.4, "mu_s": 0.5, "r": 0.006, "initial_force": 10.0})
    for _ in range(120):
        *_, info = env.step(np.array([0.0], dtype=np.float32))
    ratio = float(env.unwrapped.simulation.plant.pads["normal"][0, 0]) / 5.0
    assert ratio > 2.0
    expected = [0.5 * ratio**-0.3, 0.4 * ratio**-0.3, 0.006 * ratio**0.2]
    assert info["true"] == pytest.approx(expected, rel=1e-4)
    env.close()


def test_rows_of_a_batch_have_pads_of_their_own():
    arguments = {"randomization": "lab", "disable_env_checker": True}
    batch = gym.make_vec(f"slipgym:{LINEAR}", num_envs=3, randomization="lab")
    singles = [gym.make(f"slipgym:{LINEAR}", engine="planar", **arguments) for _ in range(3)]
    rows, _ = batch.reset(seed=7)
    alone = [env.reset(seed=7 + i)[0] for i, env in enumerate(singles)]
    np.testing.assert_array_equal(rows, np.stack(alone))
    for t in range(60):
        force = np.full((3, 1), 0.1 * np.sin(t / 5.0), dtype=np.float32)
        rows, rewards, *_ = batch.step(force)
        for i, env in enumerate(singles):
            row, reward, *_ = env.step(force[i])
            np.testing.assert_array_equal(rows[i], row)
            assert rewards[i] == reward
    batch.close()
    for env in singles:
        env.close()
