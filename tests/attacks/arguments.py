"""Attacks on keyword arguments, configurations, randomizations, reset options and actions."""

from __future__ import annotations

import warnings
from dataclasses import asdict
from functools import cache
from typing import Any, get_args

import gymnasium as gym
import numpy as np

import estimator as estimators
from estimator.registry import specification
from slipgym.config import load
from slipgym.config.load import load_randomization, merge
from slipgym.envs.arguments import FRICTION_SOURCES, OBSERVATION_MODES, ActionMode
from slipgym.registration import ENVIRONMENTS
from tests.attacks.cases import (
    ACCEPTED,
    REFUSED,
    STOPPED,
    Attack,
    at,
    attempt,
    leaves,
    near,
    placed,
    value,
)

IDS = tuple(ENVIRONMENTS)
KEYWORDS = {
    "friction_source": FRICTION_SOURCES,
    "material": (*load().materials, "random"),
    "sensors": ("realistic", "ideal", "lab"),
    "estimator": estimators.names(),
    "action_mode": get_args(ActionMode),
    "observation_mode": OBSERVATION_MODES,
    "history": (1, 2, 5),
    "randomization": (None, "train", "eval_ood", "lab"),
    "frame_skip": (1, 2, 4),
}
"""Keyword argument -> values that are allowed for most tasks."""
OTHERS = ("contact", "config", "engine", "render_mode", "nonsense")


@cache
def environment(env_id: str, engine: str = "planar") -> Any:
    """An environment for all cases of a process."""
    return gym.make(env_id, engine=engine, disable_env_checker=True).unwrapped


def some_id(rng: np.random.Generator) -> str:
    """Id of one of the tasks."""
    return IDS[rng.integers(len(IDS))]


def play(env: Any, steps: int = 2) -> None:
    """A reset and some steps, all of them finite.

    Raises:
        AssertionError: A number is not finite, or an observation lies outside its space.
    """
    env.reset(seed=0)
    for _ in range(steps):
        observation, reward, *_ = env.step(np.zeros(env.action_space.shape, np.float32))
        assert env.observation_space.contains(observation)
        assert np.isfinite(reward)


def _made(rng: np.random.Generator, **keywords: Any) -> str:
    def call() -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            kind = type(environment(some_id(rng)))  # gym.make would check the render mode itself
            env = kind(**{"engine": "planar", **keywords})
            try:
                play(env)
            finally:
                env.close()

    return attempt(call, (ValueError, TypeError, FileNotFoundError, RuntimeError))


def keywords(rng: np.random.Generator) -> str:
    """Some keyword arguments with values that are often allowed; in every second case one of any kind."""
    chosen: dict[str, Any] = {
        str(name): KEYWORDS[str(name)][rng.integers(len(KEYWORDS[str(name)]))]
        for name in rng.choice(list(KEYWORDS), rng.integers(0, 5), replace=False)
    }
    if rng.random() < 0.3:
        chosen["estimator"] = _some_estimator(rng)
    if rng.random() < 0.5:
        chosen[str(rng.choice([*KEYWORDS, *OTHERS]))] = value(rng)
    return _made(rng, **chosen)


def _some_estimator(rng: np.random.Generator) -> dict[str, Any]:
    """An estimator with one parameter near its default."""
    name = str(rng.choice(estimators.names()))
    parameters = asdict(specification(name).parameters())
    key = str(rng.choice(list(parameters)))
    return {"name": name, key: near(rng, parameters[key])}


def config(rng: np.random.Generator) -> str:
    """Some values of the configuration replaced."""
    return _made(rng, config=_replaced(rng, {}, load().model_dump()))


def _replaced(rng: np.random.Generator, values: dict[str, Any], known: dict[str, Any]) -> dict[str, Any]:
    """Mappings with some values near the known ones, or of any kind, in their place."""
    places = leaves(known)
    for _ in range(rng.integers(1, 4)):
        place = places[rng.integers(len(places))]
        if rng.random() < 0.6:
            values = merge(values, placed(place, near(rng, at(known, place))))
        else:
            values = merge(values, placed(place[: rng.integers(1, len(place) + 1)], value(rng)))
    return values


def randomization(rng: np.random.Generator) -> str:
    """Some values of a randomization replaced."""
    values = load_randomization("eval_ood").model_dump(mode="json", exclude_none=True)
    return _made(rng, randomization=_replaced(rng, values, values))


PLAUSIBLE = {
    "mu_s": 0.6,
    "mu_c": 0.4,
    "r": 0.01,
    "object_mass": 0.2,
    "object_size": (0.08, 0.03, 0.16),
    "com_offset": (0.005, 0.005),
    "initial_force": 10.0,
    "duration": 2.0,
    "distance": 0.02,
    "finger_friction": (1.0, 1.1),
    "cop_offset": ((0.001, 0.0), (0.0, 0.001)),
    "randomization_scale": 0.5,
}
"""Reset options that are often allowed."""


def options(rng: np.random.Generator) -> str:
    """Reset options of any value, then steps."""
    env = environment(some_id(rng))
    names = [*env.task.options.model_fields, "nonsense"]
    chosen = {str(name): value(rng) for name in rng.choice(names, rng.integers(0, 2), replace=False)}
    for name in rng.choice(list(PLAUSIBLE), rng.integers(1, 4), replace=False):
        chosen[str(name)] = near(rng, PLAUSIBLE[str(name)])

    def call() -> None:
        env.reset(seed=0, options=chosen)
        env.step(np.zeros(env.action_space.shape, np.float32))

    outcome = attempt(call)
    play(env, 1)
    return outcome


def actions(rng: np.random.Generator) -> str:
    """An action of any kind."""
    env = environment(some_id(rng))
    env.reset(seed=0)
    shape = env.action_space.shape
    kinds: list[Any] = [
        value(rng),
        [value(rng) for _ in range(shape[0])],
        rng.uniform(-2.0, 2.0, shape),
        np.array([object()] * shape[0], dtype=object),
        np.zeros(shape, rng.choice(["c16", "M8[s]", "m8[s]", "U3", "S2", "?", "u8", "f2", "g"])),
        np.ma.masked_array(np.zeros(shape), mask=True),
    ]
    outcome = attempt(lambda: env.step(kinds[rng.integers(len(kinds))]), (ValueError,))
    play(env, 1)
    return outcome


EXPLAINED = ACCEPTED, REFUSED, STOPPED
ATTACKS = (
    Attack("keywords", keywords, 15, EXPLAINED),
    Attack("configuration", config, 25, EXPLAINED),
    Attack("randomization", randomization, 15, EXPLAINED),
    Attack("reset options", options, 40, EXPLAINED),
    Attack("actions", actions, 60, (ACCEPTED, REFUSED)),
)
