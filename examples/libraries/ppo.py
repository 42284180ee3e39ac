"""PPO in one file: python ppo.py [steps [task]]"""

import sys
from collections import defaultdict, deque

import gymnasium as gym
import numpy as np
import torch
from gymnasium.wrappers import vector as wrappers
from torch import nn
from torch.distributions import Normal

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 300_000
task = sys.argv[2] if len(sys.argv) > 2 else "LinearSlip"
n, length, epochs, minibatch = 128, 32, 3, 512
gamma, lam, clip, learning_rate = 0.9, 0.9, 0.2, 3e-3
shaping = {"tasks": {"linear_slip": {"reward": {"solved": 0.0, "drop": 0.2, "sideways": 1.0}}}}
torch.manual_seed(0)
torch.set_num_threads(1)
modes = {"frame_skip": 4, "history": 1, "randomization": "train"}
envs = gym.make_vec(f"slipgym:slipgym/{task}-v0", num_envs=n, config=shaping, **modes)
envs = wrappers.ClipAction(wrappers.RecordEpisodeStatistics(envs))
pair = [column.name in ("measured_slip_y", "reference_position") for column in envs.unwrapped.columns]
tracking = np.kron(np.eye(2), pair).T  # reference less distance slid, in both observations
space = gym.spaces.Box(-np.inf, np.inf, (len(tracking) + 2,))
envs = wrappers.TransformObservation(envs, lambda seen: np.append(seen, seen @ tracking, 1), None, space)
envs = wrappers.NormalizeReward(wrappers.NormalizeObservation(envs), gamma)
width, k = len(tracking) + 2, envs.single_action_space.shape[0]
gains = np.append(np.ones(len(tracking)), [5.0, 5.0])  # the first errors are large, and count in the variance


def mlp(outputs, gain):
    layers = [nn.Linear(width, 64), nn.ReLU(), nn.Linear(64, 64), nn.ReLU(), nn.Linear(64, outputs)]
    for layer, scale in zip(layers[::2], (2**0.5, 2**0.5, gain), strict=True):
        nn.init.orthogonal_(layer.weight, scale)
        nn.init.zeros_(layer.bias)
    return nn.Sequential(*layers)


actor, critic, log_std = mlp(k, 0.01), mlp(1, 1.0), nn.Parameter(torch.zeros(k))
parameters = [*actor.parameters(), *critic.parameters(), log_std]
optimizer = torch.optim.Adam(parameters, learning_rate, eps=1e-5)


def tensor(array, gains=1.0):
    return torch.as_tensor(np.clip(array * gains, -10, 10), dtype=torch.float32)


def log_probability(observations, actions):
    return Normal(actor(observations), log_std.exp()).log_prob(actions).sum(-1)


observations, _ = envs.reset(seed=0)
updates, returns, solved = max(steps // (n * length), 1), deque(maxlen=100), deque(maxlen=100)
over = np.zeros(n, bool)  # rows whose episode is over: the next step only begins another one
for update in range(1, updates + 1):
    optimizer.param_groups[0]["lr"] = learning_rate * (1.05 - update / updates)
    rows = defaultdict(list)
    with torch.no_grad():
        for _ in range(length):
            seen = tensor(observations, gains)
            action = Normal(actor(seen), log_std.exp()).sample()
            observations, reward, terminated, truncated, infos = envs.step(action.numpy())
            rows["observation"].append(seen)
            rows["action"].append(action)
            rows["log"].append(log_probability(seen, action))
            rows["value"].append(critic(seen)[:, 0])
            rows["reward"].append(tensor(reward))
            follows = ~(terminated | infos["finished"])  # only a limit of yours cuts an episode
            rows["next"].append(critic(tensor(observations, gains))[:, 0] * torch.as_tensor(follows))
            rows["counts"].append(torch.as_tensor(~over))
            over = terminated | truncated
            rows["ended"].append(torch.as_tensor(over))
            if over.any():
                returns += infos["episode"]["r"][over].tolist()
                solved += infos["is_success"][over].tolist()
        data = {name: torch.stack(values) for name, values in rows.items()}
        advantage, advantages = torch.zeros(n), []
        for t in reversed(range(length)):
            delta = data["reward"][t] + gamma * data["next"][t] - data["value"][t]
            advantage = delta + gamma * lam * ~data["ended"][t] * advantage
            advantages.append(advantage)
        data["advantage"] = torch.stack(advantages[::-1])
        data["return"] = data["advantage"] + data["value"]
        counts = data.pop("counts")
        data = {name: values[counts] for name, values in data.items()}
    for _ in range(epochs):
        for chosen in torch.randperm(len(data["log"])).split(minibatch):
            batch = {name: values[chosen] for name, values in data.items()}
            ratio = (log_probability(batch["observation"], batch["action"]) - batch["log"]).exp()
            gain = (batch["advantage"] - batch["advantage"].mean()) / (batch["advantage"].std() + 1e-8)
            surrogate = torch.min(ratio * gain, ratio.clamp(1 - clip, 1 + clip) * gain).mean()
            error = (critic(batch["observation"])[:, 0] - batch["return"]).square().mean()
            optimizer.zero_grad()
            (0.5 * error - surrogate).backward()
            nn.utils.clip_grad_norm_(parameters, 0.5)
            optimizer.step()
    if returns:
        print(f"{update * n * length:8d} steps: return {np.mean(returns):7.2f}, solved {np.mean(solved):.0%}")
envs.close()
