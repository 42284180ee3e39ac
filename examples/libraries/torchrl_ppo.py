"""PPO of TorchRL: python torchrl_ppo.py [steps [task]]"""

import sys

import gymnasium as gym
import numpy as np
import torch
from gymnasium.wrappers import vector as wrappers
from tensordict.nn import AddStateIndependentNormalScale, TensorDictModule
from torch import nn
from torchrl.collectors import Collector
from torchrl.envs import (
    Compose,
    DoubleToFloat,
    GymWrapper,
    RewardScaling,
    RewardSum,
    TransformedEnv,
    VecNormV2,
)
from torchrl.modules import IndependentNormal, ProbabilisticActor, ValueOperator
from torchrl.objectives import ClipPPOLoss
from torchrl.objectives.value import GAE

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 300_000
task = sys.argv[2] if len(sys.argv) > 2 else "LinearSlip"
n, length, epochs, minibatch, gamma = 128, 32, 3, 512, 0.9
shaping = {"tasks": {"linear_slip": {"reward": {"solved": 0.0, "drop": 0.2, "sideways": 1.0}}}}
modes = {"frame_skip": 4, "history": 1, "randomization": "train"}
modes["autoreset_mode"] = "Disabled"  # TorchRL resets rows itself

torch.manual_seed(0)
torch.set_num_threads(1)
envs = gym.make_vec(f"slipgym:slipgym/{task}-v0", num_envs=n, config=shaping, **modes)
pair = [column.name in ("measured_slip_y", "reference_position") for column in envs.unwrapped.columns]
tracking = np.kron(np.eye(2), pair).T  # reference less distance slid, in both observations
space = gym.spaces.Box(-np.inf, np.inf, (len(tracking) + 2,))
envs = wrappers.ClipAction(envs)
envs = wrappers.TransformObservation(envs, lambda seen: np.append(seen, seen @ tracking, 1), None, space)
envs.autoreset_mode = envs.metadata["autoreset_mode"]  # TorchRL asks for it, the wrapper lacks it
normalised = VecNormV2(["observation"], ["observation"], decay=0.999)
transforms = Compose(DoubleToFloat(), RewardSum(), RewardScaling(0.0, 20.0), normalised)
env = TransformedEnv(GymWrapper(envs, device="cpu"), transforms)
env.set_seed(0)
width, k = env.observation_spec["observation"].shape[-1], env.action_spec.shape[-1]


class Gains(nn.Module):
    """The first tracking errors are large, and count in the variance."""

    def forward(self, seen):
        return torch.cat((seen[..., :-2], 5.0 * seen[..., -2:]), -1).clamp(-10.0, 10.0)


def mlp(outputs, *more):
    return nn.Sequential(
        Gains(), nn.Linear(width, 64), nn.ReLU(), nn.Linear(64, 64), nn.ReLU(), nn.Linear(64, outputs), *more
    )


actor = ProbabilisticActor(
    TensorDictModule(mlp(k, AddStateIndependentNormalScale(k)), ["observation"], ["loc", "scale"]),
    in_keys=["loc", "scale"],
    spec=env.action_spec_unbatched,
    distribution_class=IndependentNormal,
    return_log_prob=True,
)
critic = ValueOperator(mlp(1), in_keys=["observation"])
advantage = GAE(gamma=gamma, lmbda=0.9, value_network=critic, average_gae=True)
loss = ClipPPOLoss(actor, critic, clip_epsilon=0.2, entropy_coeff=0.0, critic_coeff=0.5)
optimizer = torch.optim.Adam(loss.parameters(), lr=3e-3)
collector = Collector(
    env,
    actor,
    auto_register_policy_transforms=True,
    frames_per_batch=n * length,
    total_frames=max(steps // (n * length), 1) * n * length,
)
for update, data in enumerate(collector, 1):
    data["next", "terminated"] = data["next", "done"]  # the task's own end: nothing follows
    with torch.no_grad():
        advantage(data)
    flat = data.reshape(-1)
    for _ in range(epochs):
        for chosen in torch.randperm(len(flat)).split(minibatch):
            found = loss(flat[chosen])
            optimizer.zero_grad()
            (found["loss_objective"] + found["loss_critic"]).backward()
            nn.utils.clip_grad_norm_(loss.parameters(), 0.5)
            optimizer.step()
    collector.update_policy_weights_()
    returns = data["next", "episode_reward"][data["next", "done"]]
    if len(returns):
        print(
            f"{update * n * length:8d} steps: return {returns.mean():7.2f} over {len(returns)} episodes",
            flush=True,
        )
collector.shutdown()
