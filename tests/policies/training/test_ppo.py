"""PPO with less computing time, against Stable-Baselines3's."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.utils import set_random_seed
from stable_baselines3.common.vec_env import VecNormalize

from policies.training.adapter import make_vec_env
from policies.training.ppo import VectorPPO

ENVS, STEPS = 6, 10
CONFIG = {"tasks": {"linear_slip": {"settle": 0.1, "duration": 0.1, "hold": 0.1}}}
"""Episodes of nine steps at frame_skip 4: each rollout truncates some."""


@pytest.fixture
def learners() -> Iterator[dict[type[PPO], PPO]]:
    """Both, with the same seed, in equal environments."""
    made = {}
    for kind in (PPO, VectorPPO):
        envs = make_vec_env("slipgym/LinearSlip-v0", ENVS, 0, 1, frame_skip=4, config=CONFIG)
        made[kind] = kind(
            "MlpPolicy",
            VecNormalize(envs),
            seed=0,
            n_steps=STEPS,
            batch_size=20,
            n_epochs=2,
            ent_coef=0.01,
            device="cpu",
            policy_kwargs={"net_arch": [16, 16]},
        )
    yield made
    for model in made.values():
        env: Any = model.get_env()
        env.close()


def test_learns_the_same(learners: dict[type[PPO], PPO]) -> None:
    """Samples, values, advantages and parameters agree to rounding after rollouts that truncate episodes."""
    for model in learners.values():
        set_random_seed(0)
        model.learn(4 * ENVS * STEPS)
    theirs, ours = learners.values()
    assert len({model.num_timesteps for model in learners.values()}) == 1
    episodes = {len(model.ep_info_buffer or ()) for model in learners.values()}
    assert len(episodes) == 1
    assert min(episodes) > ENVS
    for name in ("observations", "actions", "rewards", "values", "log_probs", "advantages", "returns"):
        expected, found = (getattr(model.rollout_buffer, name) for model in (theirs, ours))
        if name != "rewards":  # the others are flattened where theirs learned from them
            found = ours.rollout_buffer.swap_and_flatten(found)
        np.testing.assert_allclose(found.reshape(expected.shape), expected, 1e-4, 1e-4, err_msg=name)
    expected = theirs.policy.state_dict()
    for name, value in ours.policy.state_dict().items():
        torch.testing.assert_close(value, expected[name], rtol=1e-4, atol=1e-4, msg=name)


def test_policy_of_one_observation(learners: dict[type[PPO], PPO]) -> None:
    """Outputs and their gradients equal those of Stable-Baselines3's policy with the same parameters."""
    theirs, ours = learners.values()
    ours.policy.load_state_dict(theirs.policy.state_dict())
    rng = np.random.default_rng(0)
    observations = torch.from_numpy(rng.normal(size=(7, *ours.observation_space.shape)).astype(np.float32))  # type: ignore[misc]
    actions = torch.from_numpy(rng.normal(size=(7, 1)).astype(np.float32))
    gradients = []
    for model in (theirs, ours):
        values, log_probs, entropy = model.policy.evaluate_actions(observations, actions)
        assert entropy is not None
        (values.sum() + (log_probs * actions[:, 0]).sum() + entropy.mean()).backward()
        gradients.append([values, log_probs, entropy.mean(), *(p.grad for p in model.policy.parameters())])
        gradients[-1] += list(model.policy(observations, deterministic=True))
    for other, mine in zip(*gradients, strict=True):
        torch.testing.assert_close(mine, other, rtol=1e-5, atol=1e-6)


def test_logged_figures(learners: dict[type[PPO], PPO]) -> None:
    """Figures of a single pass in one minibatch are those of Stable-Baselines3, before any update."""
    logged = []
    for model in learners.values():
        set_random_seed(0)
        model.n_epochs, model.batch_size = 1, ENVS * STEPS
        model.learn(ENVS * STEPS, log_interval=1000)
        logged.append(dict(model.logger.name_to_value))
    theirs, ours = logged
    assert {name for name in ours if name.startswith("train/")} <= set(theirs)
    for name in ("value_loss", "entropy_loss", "explained_variance", "std"):
        assert ours[f"train/{name}"] == pytest.approx(theirs[f"train/{name}"], rel=1e-4, abs=1e-6)
