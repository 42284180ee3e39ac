"""Learners of Stable-Baselines3 take the batch."""

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
contrib = pytest.importorskip("sb3_contrib")
import stable_baselines3 as sb3  # noqa: E402
import torch  # noqa: E402
from stable_baselines3.common.utils import obs_as_tensor  # noqa: E402

import policies  # noqa: E402

SHORT = {"config": {"tasks": {"linear_slip": {"duration": 0.2, "settle": 0.1, "hold": 0.1}}}, "threads": 1}
SMALL = {"net_arch": [8]}
ROLLOUT = {"n_steps": 32, "batch_size": 64, "n_epochs": 1}
REPLAY = {"learning_starts": 64, "batch_size": 16, "buffer_size": 400, "train_freq": 16}
LEARNERS = {
    "ppo": (sb3.PPO, "MlpPolicy", ROLLOUT, SMALL),
    "recurrent ppo": (contrib.RecurrentPPO, "MlpLstmPolicy", ROLLOUT, {**SMALL, "lstm_hidden_size": 8}),
    "sac": (sb3.SAC, "MlpPolicy", REPLAY, SMALL),
    "tqc": (contrib.TQC, "MlpPolicy", REPLAY, SMALL),
}


def learned(kind, envs, steps, policy=None):
    learner, name, hyperparameters, networks = LEARNERS[kind]
    model = learner(
        policy or name, envs, seed=3, policy_kwargs=dict(networks), device="cpu", **hyperparameters
    )
    before = {key: value.clone() for key, value in model.policy.state_dict().items()}
    model.learn(steps)
    after = model.policy.state_dict()
    assert any(not torch.equal(before[key], after[key]) for key in before)
    assert all(torch.isfinite(value).all() for value in after.values())
    return model


@pytest.mark.parametrize("normalise", [None, {}])
@pytest.mark.parametrize("kind", LEARNERS)
def test_a_learner_takes_steps(kind, normalise):
    threads = torch.get_num_threads()
    envs = policies.make_vec_env("slipgym/LinearSlip-v0", 4, seed=0, normalise=normalise, **SHORT)
    model = learned(kind, envs, 256)
    envs.close()
    assert model.num_timesteps == 256
    assert len(model.ep_info_buffer) >= 4
    assert torch.get_num_threads() == threads


def test_learning_is_the_same_again():
    weights = []
    for threads in (1, 2):
        envs = policies.make_vec_env("slipgym/LinearSlip-v0", 4, **{**SHORT, "threads": threads})
        weights.append(learned("ppo", envs, 256).policy.state_dict())
        envs.close()
    assert all(torch.equal(weights[0][key], weights[1][key]) for key in weights[0])


def test_a_replay_buffer_knows_cut_episodes_from_dropped_boxes():
    envs = policies.make_vec_env("slipgym/LinearSlip-v0", 2, **SHORT)
    model = sb3.SAC("MlpPolicy", envs, seed=0, device="cpu", policy_kwargs=dict(SMALL), learning_starts=10**6)
    model.learn(160)
    buffer = model.replay_buffer
    done, cut = buffer.dones[:80].astype(bool), buffer.timeouts[:80].astype(bool)
    assert done.any()
    assert not (cut & ~done).any()
    assert np.array_equal(buffer.next_observations[:79][~done[:79]], buffer.observations[1:80][~done[:79]])
    envs.close()


@pytest.mark.parametrize("history", [0, 1])
def test_torch_takes_observations_without_a_copy(history):
    envs = policies.make_vec_env("slipgym/LinearSlip-v0", 4, seed=0, history=history, **SHORT)
    observations = envs.reset()
    for take in (
        obs_as_tensor,
        lambda array, _: torch.from_numpy(array),
        lambda array, _: torch.from_dlpack(array),
    ):
        tensor = take(observations, "cpu")
        assert tensor.dtype is torch.float32
        assert tensor.data_ptr() == observations.ctypes.data
        before = tensor.clone()
        observations = envs.step(np.zeros((4, 1), np.float32))[0]
        assert torch.equal(tensor, before)  # the next step writes elsewhere
        assert not np.array_equal(observations, before)
    envs.close()
