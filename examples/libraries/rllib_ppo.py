"""PPO of RLlib: python rllib_ppo.py [steps [task]]"""

import sys

import gymnasium as gym
import numpy as np
import ray
from gymnasium.wrappers import vector as wrappers
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.core.rl_module.default_model_config import DefaultModelConfig
from ray.tune import register_env

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 300_000
task = sys.argv[2] if len(sys.argv) > 2 else "LinearSlip"
n, length, scale = 128, 32, 20.0
shaping = {"tasks": {"linear_slip": {"reward": {"solved": 0.0, "drop": 0.2, "sideways": 1.0}}}}
modes = {"frame_skip": 4, "history": 1, "randomization": "train"}


class TaskEnd(gym.vector.VectorWrapper):
    """Terminates at the task's own end, where nothing follows."""

    def step(self, actions):
        seen, reward, terminated, truncated, infos = self.env.step(actions)
        return seen, reward, terminated | infos["finished"], truncated & ~infos["finished"], infos


def vector(settings):
    envs = TaskEnd(gym.make_vec(f"slipgym:slipgym/{task}-v0", config=shaping, **settings))
    pair = [column.name in ("measured_slip_y", "reference_position") for column in envs.unwrapped.columns]
    tracking = np.kron(np.eye(2), pair).T  # reference less distance slid, in both observations
    space = gym.spaces.Box(-np.inf, np.inf, (len(tracking) + 2,))
    envs = wrappers.TransformObservation(envs, lambda seen: np.append(seen, seen @ tracking, 1), None, space)
    # the first errors are large, and count in the variance
    gains = np.append(np.ones(len(tracking)), [5.0, 5.0])
    envs = wrappers.TransformObservation(
        wrappers.NormalizeObservation(envs),
        lambda seen: np.clip(seen * gains, -10, 10).astype(np.float32),
        None,
        space,
    )
    return wrappers.TransformReward(envs, lambda reward: scale * reward)


ray.init(num_cpus=1, include_dashboard=False, log_to_driver=False)
register_env("slipgym", vector)
config = (
    PPOConfig()
    .environment("slipgym", env_config=modes)
    .env_runners(
        num_env_runners=0,
        num_envs_per_env_runner=n,
        gym_env_vectorize_mode=gym.VectorizeMode.VECTOR_ENTRY_POINT,  # the batch, in this process
    )
    .training(
        train_batch_size_per_learner=n * length,
        minibatch_size=512,
        num_epochs=3,
        lr=3e-3,
        gamma=0.9,
        lambda_=0.9,
        clip_param=0.2,
        use_kl_loss=False,
        grad_clip=0.5,
        vf_clip_param=float("inf"),
        vf_loss_coeff=0.5,
    )
    .rl_module(
        model_config=DefaultModelConfig(
            fcnet_hiddens=[64, 64], fcnet_activation="relu", vf_share_layers=False, free_log_std=True
        )
    )
    .debugging(seed=0)
)
algorithm = config.build_algo()
done = 0
while done < steps:
    result = algorithm.train()
    done = result["num_env_steps_sampled_lifetime"]
    found = result["env_runners"]
    if "episode_return_mean" in found:
        print(f"{int(done):8d} steps: return {found['episode_return_mean'] / scale:7.2f}", flush=True)
algorithm.stop()
ray.shutdown()
