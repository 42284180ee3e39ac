"""Behaviour cloning from a Minari dataset: python clone.py DATASET [passes]"""

import sys

import gymnasium as gym
import minari
import numpy as np
import torch

import slipgym  # noqa: F401  (registers the environments)

passes = int(sys.argv[2]) if len(sys.argv) > 2 else 60
dataset = minari.load_dataset(sys.argv[1])
episodes = list(dataset.iterate_episodes())
seen = np.concatenate([episode.observations[:-1] for episode in episodes]).astype(np.float32)
done = torch.from_numpy(np.concatenate([episode.actions for episode in episodes]).astype(np.float32))
mean, scale = seen.mean(axis=0), seen.std(axis=0) + 1e-6


def scaled(observations):
    return torch.from_numpy(((observations - mean) / scale).clip(-10.0, 10.0).astype(np.float32))


torch.manual_seed(0)
network = torch.nn.Sequential(
    torch.nn.Linear(seen.shape[1], 64), torch.nn.Tanh(),
    torch.nn.Linear(64, 64), torch.nn.Tanh(),
    torch.nn.Linear(64, done.shape[1]), torch.nn.Tanh(),
)  # fmt: skip
optimiser = torch.optim.Adam(network.parameters(), 1e-3)
inputs = scaled(seen)
for number in range(passes):
    for rows in torch.randperm(len(inputs)).split(256):
        loss = (network(inputs[rows]) - done[rows]).abs().mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    if number % 10 == 0 or number == passes - 1:
        print(f"pass {number}: error of an action {loss.item():.3f}")

spec = dataset.spec.env_spec
envs = gym.make_vec(spec.id, 100, "vector_entry_point", **{**spec.kwargs, "engine": "planar"})
observations, solved = envs.reset(seed=1_000_000)[0], np.zeros(100, bool)
running = np.ones(100, bool)
while running.any():
    with torch.no_grad():
        actions = network(scaled(observations)).numpy()
    observations, _, terminated, truncated, infos = envs.step(actions)
    over = running & (terminated | truncated)
    solved[over], running[over] = infos["is_success"][over], False
print(f"the clone solves {solved.sum()} of 100 new episodes")
