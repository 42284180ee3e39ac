"""Plays an episode of each environment and prints digests of every bit that it said. Run as a script."""

import argparse
import hashlib

import gymnasium as gym
import numpy as np

import slipgym  # noqa: F401

np.set_printoptions(precision=17, floatmode="unique", threshold=10_000)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("env_ids", nargs="+")
    parser.add_argument(
        "--disturbed", action="store_true", help="earlier episodes, others beside, last id first"
    )
    parser.add_argument("--contact", default="ellipsoid")
    parser.add_argument("--randomization", default="none")
    arguments = parser.parse_args()
    made = {
        "action_mode": "grip_force",
        "contact": arguments.contact,
        "randomization": arguments.randomization,
    }
    said = {}
    for env_id in reversed(arguments.env_ids) if arguments.disturbed else arguments.env_ids:
        said[env_id] = play(env_id, made, arguments.disturbed)
    for env_id in arguments.env_ids:
        print(env_id, hashlib.sha256("".join(said[env_id]).encode()).hexdigest())


def play(env_id, made, disturbed) -> list[str]:
    if disturbed:
        others = [gym.make(env_id, **made) for _ in range(3)]
        others[0].close()
        episode(others[1], 7, steps=50)
    env = gym.make(env_id, **made)
    if disturbed:
        episode(env, 5, options={"object_mass": 0.37, "mu_c": 0.2, "mu_s": 0.3}, scale=-1.0)
        episode(env, 6, options={"com_offset": (0.0, 0.01), "object_size": (0.4, 0.02, 0.3)}, steps=100)
        env.reset()
    return episode(env, 42)


def episode(env, seed, options=None, steps=10_000, scale=1.0) -> list[str]:
    rng = np.random.default_rng(seed)
    said = [repr(env.reset(seed=seed, options=options))]
    for _ in range(steps):
        result = env.step(np.float32([scale * rng.uniform(-0.9, 1.0)]))
        said.append(repr(result))
        if result[2] or result[3]:
            break
    return said


if __name__ == "__main__":
    main()
