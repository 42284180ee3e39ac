"""Attacks on running environments: interrupts, lost clients, threads, forks, and many steps."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any

import gymnasium as gym
import numpy as np

from lab.torture.arguments import environment, some_id
from lab.torture.cases import ACCEPTED, EQUAL, REFUSED, Attack, attempt
from lab.torture.interrupts import after_engine, before_engine, count, interrupt, lines

_OTHER = {"object_size": (0.44, 0.03, 0.3)}
ROWS, BATCH_STEPS, BULLET_STEPS = 1000, 100, 1000
"""Environments of a batch, and steps of a case: 10^7 and 10^5 a task in a full campaign."""


def said(env: Any, seed: int = 2, options: Any = None) -> str:
    """What an episode says, bit for bit."""
    with np.printoptions(precision=17, floatmode="unique", threshold=10_000):
        action = np.zeros(env.action_space.shape, np.float32)
        return repr([env.reset(seed=seed, options=options), *(env.step(action) for _ in range(3))])


@cache
def _expected(env_id: str, engine: str) -> str:
    return said(environment(env_id, engine))


def interrupts(rng: np.random.Generator) -> str:
    """A call interrupted at a random moment; afterwards an episode is the one of an untouched environment."""
    env_id, engine = some_id(rng), ["bullet", "planar"][rng.integers(2)]
    expected = _expected(env_id, engine)
    env = environment(env_id, engine)
    env.reset(seed=0)
    state = env.get_state()
    calls = {
        "step": lambda: env.step(np.zeros(env.action_space.shape, np.float32)),
        "reset": lambda: env.reset(seed=1, options=_OTHER),
        "set_state": lambda: env.set_state(state),
        "get_state": env.get_state,
    }
    call = calls[sorted(calls)[rng.integers(len(calls))]]
    place = [lines, before_engine, after_engine][rng.integers(3 if engine == "bullet" else 1)]
    total = count(place, call)
    if total:
        env.reset(seed=0)
        interrupt(place, int(rng.integers(1, total + 1)), call)
    return EQUAL if said(env) == expected else "differs"


def clients(rng: np.random.Generator) -> str:
    """The client of an environment is disconnected, or another one takes its number."""
    import pybullet

    env: Any = gym.make(some_id(rng), disable_env_checker=True).unwrapped
    if rng.random() < 0.8:
        env.reset(seed=0)
    number = env.simulation.world.client
    pybullet.disconnect(number)
    taken = pybullet.connect(pybullet.DIRECT) if rng.random() < 0.5 else None
    call = ("reset", "step", "get_state")[rng.integers(3)]
    given = (np.zeros(env.action_space.shape or (), np.float32),) if call == "step" else ()
    outcome = attempt(lambda: getattr(env, call)(*given), (RuntimeError,))
    for _ in range(2):
        env.close()
    if taken is not None:
        assert pybullet.isConnected(taken)
        pybullet.disconnect(taken)
    return outcome


def threads(rng: np.random.Generator) -> str:
    """Environments in several threads, each with its own."""
    env_id = some_id(rng)
    expected = _expected(env_id, "planar")

    def one(_: int) -> bool:
        env = gym.make(env_id, engine="planar", disable_env_checker=True).unwrapped
        return said(env) == expected

    with ThreadPoolExecutor(4) as pool:
        return EQUAL if all(pool.map(one, range(4))) else "differs"


def forks(rng: np.random.Generator) -> str:
    """An environment that goes on in a fork of the process."""
    env_id, engine = some_id(rng), ["bullet", "planar"][rng.integers(2)]
    expected, env = _expected(env_id, engine), environment(env_id, engine)
    child = os.fork()
    if child == 0:
        status = 1
        try:
            status = 0 if said(env) == expected else 1
        finally:
            os._exit(status)
    _, status = os.waitpid(child, 0)
    return EQUAL if status == 0 and said(env) == expected else "differs"


def batch(rng: np.random.Generator) -> str:
    """Steps of a batch with everything randomized."""
    env = gym.make_vec(some_id(rng), num_envs=ROWS, randomization="eval_ood")
    env.reset(seed=int(rng.integers(2**31)))
    for _ in range(BATCH_STEPS):
        actions = rng.uniform(-1.0, 1.0, env.action_space.shape or ()).astype(np.float32)
        observations, rewards, *_ = env.step(actions)
        assert np.isfinite(rewards).all()
        assert env.observation_space.contains(observations)
    env.close()
    return ACCEPTED


def bullet(rng: np.random.Generator) -> str:
    """Steps with PyBullet, everything randomized."""
    env = gym.make(some_id(rng), randomization="eval_ood", disable_env_checker=True)
    env.reset(seed=int(rng.integers(2**31)))
    for _ in range(BULLET_STEPS):
        action = rng.uniform(-1.0, 1.0, env.action_space.shape or ()).astype(np.float32)
        observation, reward, terminated, truncated, _ = env.step(action)
        assert env.observation_space.contains(observation)
        assert np.isfinite(float(reward))
        if terminated or truncated:
            env.reset()
    env.close()
    return ACCEPTED


ATTACKS = (
    Attack("interrupts", interrupts, 3000, (EQUAL,)),
    Attack("lost clients", clients, 300, (REFUSED, ACCEPTED)),
    Attack("threads", threads, 50, (EQUAL,)),
    Attack("forks", forks, 100, (EQUAL,)),
    Attack("steps of batches", batch, 1000, (ACCEPTED,)),
    Attack("steps with PyBullet", bullet, 1000, (ACCEPTED,)),
)
