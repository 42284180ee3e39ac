"""Episodes of a controller as a Minari dataset: python collect.py [episodes [task]]"""

import sys

import gymnasium as gym
import minari
import numpy as np

import policies

episodes = int(sys.argv[1]) if len(sys.argv) > 1 else 20
task, controller = sys.argv[2:] if len(sys.argv) > 2 else ("LinearSlip", "linear_slip")
name = f"slipgym/{controller}/controller-v0"

policy = policies.make(controller)
env = minari.DataCollector(
    gym.make(f"slipgym:slipgym/{task}-v0", engine="planar", randomization="train"), record_infos=False
)
solved = 0
for seed in range(episodes):
    observation, info = env.reset(seed=seed)
    state, over = None, False
    while not over:
        action, state = policy.predict(observation, state=state)
        observation, reward, terminated, truncated, info = env.step(action)
        over = terminated or truncated
    solved += info["is_success"]
if name in minari.list_local_datasets():
    minari.delete_dataset(name)
dataset = env.create_dataset(
    name,
    algorithm_name=f"slipgym's {controller}",
    author="me",
    author_email="me@example.org",
    code_permalink="https://example.org/collect.py",
    description=f"{episodes} episodes, preset train, estimated friction",
)
env.close()

dataset = minari.load_dataset(name)
returns = [episode.rewards.sum() for episode in dataset.iterate_episodes()]
steps = dataset.total_steps
print(f"{len(returns)} episodes, {steps} steps, {solved} solved, mean return {np.mean(returns):.1f}")

again = dataset.recover_environment()  # in another process: import slipgym first
for episode in dataset.iterate_episodes():  # the same seed and actions give the same observations
    again.reset(seed=int(episode.id))
    for action, expected in zip(episode.actions, episode.observations[1:], strict=True):
        observation, *_ = again.step(action)
        assert np.array_equal(observation, expected)
again.close()
print("every episode repeats itself bit for bit")
