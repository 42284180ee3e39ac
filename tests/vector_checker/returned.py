"""Checks the values that `reset` and `step` of a vector environment return: shapes, types, masks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space, create_empty_array, iterate

from tests.vector_checker.compare import arrays, demand


def check_attributes(where: str, env: VectorEnv, n: int, mode: AutoresetMode | None) -> AutoresetMode:
    """Check number, spaces and metadata.

    Args:
        where: Name of the call or environment, for error messages.
        env: The environment.
        n: Requested number of environments.
        mode: Requested autoreset mode; None: any.

    Returns:
        The environment's autoreset mode.

    Raises:
        AssertionError: A check fails.
    """
    demand(isinstance(env, VectorEnv), f"{where}: {type(env).__name__} is no gymnasium.vector.VectorEnv")
    demand(env.num_envs == n, f"{where}: num_envs is {env.num_envs}, asked for were {n}")
    for name in ("observation", "action"):
        single, batch = getattr(env, f"single_{name}_space"), getattr(env, f"{name}_space")
        demand(
            batch == batch_space(single, n),
            f"{where}: {name}_space is {batch}, not {n} times single_{name}_space {single}",
        )
    own = env.metadata.get("autoreset_mode")
    demand(
        isinstance(own, AutoresetMode), f"{where}: metadata['autoreset_mode'] = {own!r} is no AutoresetMode"
    )
    demand(mode in (None, own), f"{where}: metadata['autoreset_mode'] is {own}, asked for was {mode}")
    return own  # pyright: ignore[reportReturnType]


def check_observations(where: str, env: VectorEnv, observations: Any) -> list[Any]:
    """Check observations against the spaces, and return them row by row.

    Raises:
        AssertionError: Structure, shape or dtype differs from the space's, or a row is outside the space.
    """
    expected = dict(arrays(create_empty_array(env.single_observation_space, env.num_envs)))
    found = dict(arrays(observations))
    demand(
        expected.keys() == found.keys(),
        f"{where}: observations have the parts {list(found)}, the space has {list(expected)}",
    )
    for path, array in found.items():
        there = expected[path]
        demand(
            (array.shape, array.dtype) == (there.shape, there.dtype),
            f"{where}: observations{path} are {array.dtype} {array.shape}, not {there.dtype} {there.shape}",
        )
    rows = list(iterate(env.observation_space, observations))
    for i, row in enumerate(rows):
        if not env.single_observation_space.contains(row):
            raise AssertionError(f"{where}: the observation of row {i} is outside the space: {row}")
    return rows


def check_numbers(where: str, n: int, rewards: Any, terminated: Any, truncated: Any) -> None:
    """Check rewards and flags.

    Raises:
        AssertionError: One is not an array (n,) of its kind, or a reward is not finite.
    """
    for name, kind, array in (
        ("rewards", "f", rewards),
        ("terminations", "b", terminated),
        ("truncations", "b", truncated),
    ):
        demand(
            isinstance(array, np.ndarray) and array.shape == (n,) and array.dtype.kind == kind,
            f"{where}: {name} must be an array ({n},) of {'floats' if kind == 'f' else 'bool'}, got "
            f"{getattr(array, 'dtype', type(array).__name__)} {getattr(array, 'shape', '')}",
        )
    bad = np.flatnonzero(~np.isfinite(rewards))
    demand(not len(bad), f"{where}: the reward of row {bad[:1]} is not finite")


def check_infos(where: str, n: int, infos: Any, allowed: np.ndarray, path: str = "infos") -> None:
    """Check that every info is an array (n, ...) or nested infos, with its mask beside it.

    Args:
        where: Name of the call or environment, for error messages.
        n: Number of environments.
        infos: The infos.
        allowed: Rows that may have infos, (n,) bool.
        path: Path of the infos, for error messages.

    Raises:
        AssertionError: An info or a mask is missing or has another shape.
    """
    demand(isinstance(infos, Mapping), f"{where}: {path} must be a dict, got {type(infos).__name__}")
    for key, value in infos.items():
        here = f"{path}[{key!r}]"
        demand(isinstance(key, str), f"{where}: {here}: keys must be strings")
        if key.startswith("_") and key[1:] in infos:
            good = isinstance(value, np.ndarray) and value.shape == (n,) and value.dtype == np.bool_
            demand(good, f"{where}: the mask {here} must be an array ({n},) of bool")
            extra = np.flatnonzero(value & ~allowed)
            demand(not len(extra), f"{where}: the mask {here} is True for row {extra[:1]}, which has no info")
            continue
        demand(f"_{key}" in infos, f"{where}: {here} has no mask '_{key}' beside it")
        if isinstance(value, Mapping):
            check_infos(where, n, value, allowed & infos[f"_{key}"], here)
        else:
            good = isinstance(value, np.ndarray) and value.shape[:1] == (n,)
            demand(good, f"{where}: {here} must be an array ({n}, ...) or a dict, got {type(value).__name__}")


def info_of(infos: Mapping[str, Any], i: int) -> dict[str, Any]:
    """Infos of row i."""
    own = {}
    for key, value in infos.items():
        if f"_{key}" in infos and infos[f"_{key}"][i]:
            own[key] = info_of(value, i) if isinstance(value, Mapping) else value[i]
    return own
