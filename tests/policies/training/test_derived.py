"""Columns that the learner reads besides those of the observation."""

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
import policies
from policies.training import checkpoints, folder, run, vector
from policies.training import model as learners

DERIVED = {
    "error": {"measured_slip_y": -1.0, "reference_position": -1.0},
    "grip": {"f_n_1": 1.0, "f_n_2": 1.0},
}


@pytest.fixture
def config(small):
    environment = {**small().environment.model_dump(), "history": 1}
    return small(derived=DERIVED, environment=environment, engine_threads=1)


def expected(observations, names):
    """An observation's columns and what DERIVED adds, earlier observation first."""
    parts = np.split(observations, 2, axis=-1)
    values = [
        sum(factor * part[..., names.index(column)] for column, factor in combination.items())
        for part in parts
        for combination in DERIVED.values()
    ]
    return np.concatenate([observations, np.stack(values, -1)], -1)


def test_columns_follow_the_observation(config):
    envs = vector.make(config, 3, 4)
    alone = vector.make(config.model_copy(update={"derived": {}}), 3, 4)
    names = [column.name for column in envs.get_attr("columns")[0]]
    assert envs.observation_space.shape == (2 * len(names) + 4,)
    found, plain, ends = envs.reset(), alone.reset(), 0
    actions = np.random.default_rng(0).uniform(-1.0, 0.0, (40, 4, 1)).astype(np.float32)
    for action in actions:
        assert found.dtype == np.float32
        np.testing.assert_allclose(found, expected(plain, names), rtol=1e-6, atol=1e-6)
        (found, _, dones, infos), (plain, _, _, others) = envs.step(action), alone.step(action)
        for i in np.flatnonzero(dones):
            last = expected(others[i]["terminal_observation"], names)
            np.testing.assert_allclose(infos[i]["terminal_observation"], last, rtol=1e-6, atol=1e-6)
            ends += 1
    assert ends >= 8


@pytest.mark.parametrize("observation", [True, False])
def test_the_file_acts_as_the_learner(config, tmp_path, observation):
    config = config.model_copy(
        update={"normalisation": config.normalisation.model_copy(update={"observation": observation})}
    )
    folder.begin(tmp_path / "run", config, 3)
    run.train(tmp_path / "run", progress=False)
    policy = policies.load(tmp_path / "run" / "policy")
    envs = vector.make(config, 5)
    model = learners.make(config, learners.normalised(config, envs, training=False), 3)
    best = checkpoints.read(checkpoints.best(tmp_path / "run"))["learner"]
    learners.set_parameters(model, best)
    frozen = model.get_vec_normalize_env()
    learners.set_normalisation(frozen, best["normalisation"])
    seen, width, largest = envs.reset(), policy.width, 0.0
    if observation:
        assert np.array_equal(frozen.obs_rms.mean[width:], np.zeros(4))  # derived columns keep their scale
        assert np.array_equal(frozen.obs_rms.var[width:], np.ones(4))
    for action in np.random.default_rng(1).uniform(-1.0, 0.0, (30, 2, 1)).astype(np.float32):
        normal = frozen.normalize_obs(seen)
        largest = max(largest, np.abs(normal[:, width:]).max())
        wanted, _ = model.predict(normal, deterministic=True)
        given, _ = policy.predict(seen[:, :width])
        np.testing.assert_allclose(given, wanted, atol=1e-4)
        seen = envs.step(action)[0]
    assert largest > config.normalisation.clip  # which bounds the observation's own columns alone


def test_what_does_not_fit_is_refused(small, config):
    wrong = config.model_copy(update={"derived": {"error": {"slip": 1.0}}})
    with pytest.raises(ValueError, match="derived: unknown column 'slip'"):
        vector.make(wrong, 0)
    with pytest.raises(ValueError, match="derived needs algorithm 'ppo'"):
        small(derived=DERIVED, algorithm="sac")
