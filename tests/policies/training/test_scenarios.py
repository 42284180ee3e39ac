"""Environments whose episodes differ in their options of reset, by configuration."""

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
from gymnasium.vector import AutoresetMode

from policies.training import vector
from policies.training.adapter import SlipVecEnv, make_vec_env

VARY = {"distance": [0.02, 0.03], "duration": [0.2, 0.3]}
WANTED = [(0.02, 0.2), (0.02, 0.3), (0.03, 0.2), (0.03, 0.3), (0.02, 0.2)]


def test_every_environment_keeps_its_combination(small):
    config = small(vary=VARY, engine_threads=1)
    envs = vector.make(config, 3, len(WANTED))
    distance = envs.get_attr("columns")[0]
    at = [column.name for column in distance].index("distance")
    found = envs.reset()
    for _ in range(30):  # the longest episode has 15 steps
        assert found[:, at].tolist() == pytest.approx([distance for distance, _ in WANTED])
        found, _, dones, infos = envs.step(np.zeros((len(WANTED), 1), np.float32))
        for (_, duration), done, info in zip(WANTED, dones, infos, strict=True):
            if done:
                assert info["episode"]["l"] == (0.2 + duration) * 30
    envs.close()


def test_a_batch_equals_environments_of_their_own(small):
    ours = vector.make(small(vary=VARY, engine_threads=1), 3, 5)
    config = small(vary=VARY, engine="bullet")
    made = config.environment.model_dump()
    theirs = vector.scalar(config.task, 5, config.combinations(), False, engine="planar", **made)
    theirs.seed(3)
    assert np.array_equal(ours.reset(), theirs.reset())
    rng, ends = np.random.default_rng(0), 0
    for _ in range(60):
        actions = rng.uniform(-1.0, 1.0, (5, 1)).astype(np.float32)
        found, wanted = ours.step(actions), theirs.step(actions)
        assert all(np.array_equal(a, b) for a, b in zip(found[:3], wanted[:3], strict=True))
        for i in np.flatnonzero(found[2]).tolist():
            last = [infos[i]["terminal_observation"] for infos in (found[3], wanted[3])]
            assert np.array_equal(*last)
            ends += 1
    assert ends >= 15
    ours.close()
    theirs.close()


def test_options_of_one_reset_come_on_top(small):
    for engine in ("planar", "bullet"):
        envs = vector.make(small(vary=VARY, engine=engine), 3, 2)
        columns = [column.name for column in envs.get_attr("columns")[0]]
        at = [columns.index(name) for name in ("distance", "time_left")]
        envs.set_options([{"distance": 0.05}, {}])
        assert envs.reset()[:, at].ravel().tolist() == pytest.approx([0.05, 0.4, 0.02, 0.5])
        assert envs.reset()[:, at].ravel().tolist() == pytest.approx([0.02, 0.4, 0.02, 0.5])
        envs.close()


def test_wrong_values_are_named(small):
    with pytest.raises(ValueError, match="distance"):
        small(vary={"distance": [-1.0]})
    with pytest.raises(ValueError, match="angle"):
        small(vary={"angle": [0.3]})
    one = "slipgym:slipgym/LinearSlip-v0"
    with pytest.raises(ValueError, match="3 environments need as many scenarios, got 1"):
        make_vec_env(one, 3, scenarios=[{}])
    batch = make_vec_env(one, 2).unwrapped.env
    with pytest.raises(ValueError, match=AutoresetMode.DISABLED.value):
        SlipVecEnv(batch, [{}, {}])


def test_it_learns_with_the_shaping_and_is_evaluated_without(small):
    shaping = {"tasks": {"linear_slip": {"reward": {"effort": 1e5}, "tolerance": 0.005}}}
    config, rewards = small(shaping=shaping, engine_threads=1), []
    assert config.environment.config["tasks"]["linear_slip"] == {"duration": 0.2, "settle": 0.1, "hold": 0.1}
    for shaped in (False, True):
        envs = vector.make(config, 0, 1, shaped)
        assert envs.get_attr("settings")[0].tolerance == (0.005 if shaped else 0.002)
        envs.reset()
        rewards.append(envs.step(np.ones((1, 1), np.float32))[1].item())
        envs.close()
    assert rewards[1] < -100.0 < rewards[0]
    with pytest.raises(ValueError, match="toleranse"):
        small(shaping={"tasks": {"linear_slip": {"toleranse": 1.0}}})


@pytest.mark.parametrize("vary", [{}, VARY])
def test_environments_spread_over_their_episodes(small, vary):
    config = small(vary=vary, spread=True, engine_threads=1)
    envs = vector.make(config, 3, 60, shaped=True)
    first = envs.reset()
    batch = envs.venv.env
    episode = batch.simulation.episode
    shares = np.sort(episode["step"] / episode["steps"])
    evenly = (np.arange(60) + 0.5) / 60
    # a whole step of 12 to 15, and the discrepancy of so many golden multiples: below 3 / 60
    assert np.abs(shares - evenly).max() < 1 / 12 + 3 / 60
    at = [column.name for column in envs.get_attr("columns")[0]].index("time_left")
    left = (episode["steps"] - episode["step"]) * batch.simulation.step_time
    assert first[:, at] == pytest.approx(left, abs=1e-6)
    assert np.array_equal(first, vector_reset(config, 60))
    assert np.ptp(vector.make(config, 3, 60).reset()[:, at]) <= 0.1 + 1e-6  # evaluations begin at the start
    envs.close()


def vector_reset(config, count):
    """First observations of new environments."""
    envs = vector.make(config, 3, count, shaped=True)
    found = envs.reset()
    envs.close()
    return found


def test_only_the_batch_spreads(small):
    with pytest.raises(ValueError, match="spread needs engine 'planar'"):
        small(spread=True, engine="bullet")
