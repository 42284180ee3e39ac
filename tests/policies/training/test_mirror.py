"""Learning from mirror images: which columns change sign, and that the physics has that symmetry."""

import gymnasium as gym
import numpy as np
import pytest

pytest.importorskip("rsl_rl")
import torch

from policies.training import files, model


@pytest.fixture(scope="module")
def config():
    return files.load("planar_slip_scratch")


def episode(config, side):
    """Observations and rewards of an episode whose target and wrist are to one side, +1 or -1."""
    given = config.environment.model_dump() | {"sensors": "ideal", "observation_mode": "dict"}
    env = gym.make("slipgym:slipgym/PlanarSlip-v0", **given)
    pose = {"slide": 0.014, "heading": side * 0.7, "turn": side * 0.5}
    observation, _ = env.reset(seed=3, options=pose)
    rng, found, rewards = np.random.default_rng(0), [observation], []
    for pitch_rate in rng.normal(0.0, 0.3, 40).clip(-1.0, 1.0):
        observation, reward, *_ = env.step(np.array([-0.1, side * pitch_rate], np.float32))
        found.append(observation)
        rewards.append(reward)
    env.close()
    return {group: np.array([one[group] for one in found]) for group in observation}, np.array(rewards)


def test_a_mirrored_episode_is_the_mirror_image(config):
    learner = model.begin(config.model_copy(update={"num_envs": 2}), 0)
    (left, rewards), (right, others) = (episode(config, side) for side in (1, -1))
    places = {"policy": "columns", "privileged": "privileged_columns"}
    names = {group: [column.name for column in learner.envs.get_attr(of)[0]] for group, of in places.items()}
    assert abs(left["privileged"][-1, names["privileged"].index("slip_y")]) > 1e-3
    np.testing.assert_allclose(rewards, others, atol=1e-6)
    for group, columns in names.items():
        signs = learner.mirror.groups[group].numpy()[: len(columns)]
        scale = np.abs(left[group]).max(axis=0)
        assert (scale[signs < 0.0] > 0.0).all()
        wrong = np.abs(left[group] * signs - right[group]).max(axis=0) > 1e-4 * scale
        assert not wrong.any(), [name for name, bad in zip(columns, wrong, strict=True) if bad]


def test_derived_columns_and_actions(config):
    learner = model.begin(config.model_copy(update={"num_envs": 2}), 0)
    assert learner.mirror.groups["policy"][-3:].tolist() == [-1.0, 1.0, -1.0]
    assert learner.mirror.action.tolist() == [1.0, -1.0]


def test_mirror_images_stand_behind_the_samples(config):
    learner = model.begin(config.model_copy(update={"num_envs": 2}), 0)
    observed = learner._observed(learner.envs.reset(), learn=False)
    both, actions = learner.mirror(None, observed, torch.tensor([[0.5, 0.25]]))
    assert actions.tolist() == [[0.5, 0.25], [0.5, -0.25]]
    for group, signs in learner.mirror.groups.items():
        assert torch.equal(both[group][:2], observed[group])
        assert torch.equal(both[group][2:], observed[group] * signs)


def test_what_is_mirrored_has_the_mean_zero(config):
    few = {"n_steps": 4, "n_minibatches": 2, "n_epochs": 1}
    ppo = config.privileged_ppo.model_copy(update=few)
    learner = model.begin(config.model_copy(update={"num_envs": 4, "privileged_ppo": ppo}), 0)
    learner.learn(16, Silent())
    for group, moments in learner.moments.items():
        mirrored = learner.mirror.groups[group].numpy()[: len(moments.mean)] < 0
        assert moments.count > 30  # 4 steps and the first, of 4 environments, each twice
        assert moments.mean[mirrored] == pytest.approx(0.0, abs=1e-12)
        assert np.abs(moments.mean[~mirrored]).max() > 1.0


class Silent:
    """A callback that does nothing."""

    def init_callback(self, learner):
        pass

    on_rollout_start = on_training_end = lambda self: None

    def on_step(self):
        return True


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"privileged_ppo.mirrored": ["f_z"]}, "mirrored: unknown column 'f_z'; did you mean 'f_y'"),
        ({"derived": {"both": {"f_x_1": 1.0, "f_y_1": 1.0}}}, "'both' combines mirrored and other columns"),
        ({"privileged_ppo.memory": 8}, "mirrored needs memory 0"),
        ({"privileged_ppo.memory_horizon": 8}, "memory_horizon needs a memory"),
    ],
)
def test_refusals(config, changes, message):
    with pytest.raises(ValueError, match=message):
        model.begin(files.changed(config, {"num_envs": 2, **changes}, "here"), 0)
