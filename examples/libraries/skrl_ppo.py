"""PPO of skrl: python skrl_ppo.py [steps [task]]"""

import sys

import gymnasium as gym
import numpy as np
import torch
from gymnasium.wrappers import vector as wrappers
from skrl.agents.torch.ppo import PPO, PPO_CFG
from skrl.envs.wrappers.torch import wrap_env
from skrl.memories.torch import RandomMemory
from skrl.models.torch import DeterministicMixin, GaussianMixin, Model
from skrl.trainers.torch import SequentialTrainer
from skrl.utils import set_seed
from torch import nn

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 300_000
task = sys.argv[2] if len(sys.argv) > 2 else "LinearSlip"
n, length, reports, gamma = 128, 32, 10, 0.9
shaping = {"tasks": {"linear_slip": {"reward": {"solved": 0.0, "drop": 0.2, "sideways": 1.0}}}}
modes = {"frame_skip": 4, "history": 1, "randomization": "train"}

set_seed(0)
torch.set_num_threads(1)
envs = gym.make_vec(f"slipgym:slipgym/{task}-v0", num_envs=n, config=shaping, **modes)
counted = wrappers.RecordEpisodeStatistics(envs)
pair = [column.name in ("measured_slip_y", "reference_position") for column in envs.unwrapped.columns]
tracking = np.kron(np.eye(2), pair).T  # reference less distance slid, in both observations
space = gym.spaces.Box(-np.inf, np.inf, (len(tracking) + 2,))
envs = wrappers.TransformObservation(
    wrappers.ClipAction(counted), lambda seen: np.append(seen, seen @ tracking, 1), None, space
)
gains = np.append(np.ones(len(tracking)), [5.0, 5.0])  # the first errors are large, and count in the variance
envs = wrappers.TransformObservation(
    wrappers.NormalizeObservation(envs), lambda seen: np.clip(seen * gains, -10, 10), None, space
)
env = wrap_env(wrappers.NormalizeReward(envs, gamma), wrapper="gymnasium")
spaces = {"observation_space": env.observation_space, "action_space": env.action_space, "device": "cpu"}


def mlp(inputs, outputs):
    return nn.Sequential(
        nn.Linear(inputs, 64), nn.ReLU(), nn.Linear(64, 64), nn.ReLU(), nn.Linear(64, outputs)
    )


class Actor(GaussianMixin, Model):
    def __init__(self):
        Model.__init__(self, **spaces)
        GaussianMixin.__init__(self)
        self.net = mlp(self.num_observations, self.num_actions)
        self.log_std = nn.Parameter(torch.zeros(self.num_actions))

    def compute(self, inputs, role=""):
        return self.net(inputs["observations"]), {"log_std": self.log_std}


class Critic(DeterministicMixin, Model):
    def __init__(self):
        Model.__init__(self, **spaces)
        DeterministicMixin.__init__(self)
        self.net = mlp(self.num_observations, 1)

    def compute(self, inputs, role=""):
        return self.net(inputs["observations"]), {}


config = PPO_CFG(
    rollouts=length,
    learning_epochs=3,
    mini_batches=8,
    discount_factor=gamma,
    gae_lambda=0.9,
    learning_rate=3e-3,
    grad_norm_clip=0.5,
    value_clip=0.0,
    value_loss_scale=0.5,
)
config.experiment.write_interval = config.experiment.checkpoint_interval = 0
agent = PPO(
    models={"policy": Actor(), "value": Critic()},
    memory=RandomMemory(memory_size=length, num_envs=n, device="cpu"),
    cfg=config,
    **spaces,
)
each = max(round(steps / (reports * n * length)), 1) * length
trainer = SequentialTrainer(
    env=env, agents=agent, cfg={"timesteps": each, "headless": True, "disable_progressbar": True}
)
for report in range(1, reports + 1):
    trainer.train()
    returns = counted.return_queue
    if returns:
        print(f"{report * each * n:8d} steps: return {np.mean(returns):7.2f}", flush=True)
