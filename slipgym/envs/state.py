"""Complete states of environments, as plain data, and the checks before one is restored."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from slipgym.config.errors import unknown
from slipgym.envs.record_checks import damaged
from slipgym.envs.simulation_state import SimulationState


@dataclass(frozen=True)
class State:
    """Base class of the states: the environment that a state belongs to."""

    made_of: Mapping[str, Any]
    """Task, configuration and arguments that the environment was made with."""

    def check(self, made_of: Mapping[str, Any]) -> None:
        """Raise ValueError if the state belongs to an environment with other arguments.

        Args:
            made_of: Task, configuration and arguments of the environment that restores the state.

        Raises:
            ValueError: Task, configuration or arguments differ; the message names the first.
        """
        if not isinstance(self.made_of, Mapping) or not made_of.keys() <= self.made_of.keys():
            raise damaged(f"made_of must be a mapping with the keys {', '.join(made_of)}")
        for name, value in made_of.items():
            if self.made_of[name] != value:
                difference = _difference(self.made_of[name], value)
                raise ValueError(
                    f"the state is of an environment with another {name}: {difference}; "
                    "make one with the same arguments"
                )


@dataclass(frozen=True)
class EnvState(State):
    """State of a `SlipEnv` between two steps or before its first episode.

    Plain data: it can be pickled, copied, and restored in another process, into any environment made with
    the same arguments, any number of times. The continuation is equal bit for bit.
    """

    generator: Mapping[str, Any]
    """State of the environment's random generator."""
    seed: int | None
    """Last seed of the generator."""
    simulation: SimulationState | None
    """Bodies, contacts, sensors, estimators and task; None before the first reset."""
    frames: np.ndarray
    """The last observations, the newest one last, (1, history + 1, m)."""


@dataclass(frozen=True)
class VectorState(State):
    """State of a `SlipVectorEnv` between two steps; plain data like an `EnvState`."""

    generators: Sequence[Mapping[str, Any]]
    """States of the environments' random generators."""
    simulation: SimulationState
    """Bodies, contacts, sensors, estimators and task."""
    frames: np.ndarray
    """The last observations, the newest one last, (n, history + 1, m)."""
    ready: np.ndarray
    """Environments that have been reset, (n,) bool."""
    over: np.ndarray
    """Environments whose episode has ended, (n,) bool."""


Kind = TypeVar("Kind", bound=State)


def checked(state: object, kind: type[Kind]) -> Kind:
    """Return `state` if it is of the given class, or raise TypeError."""
    if not isinstance(state, kind):
        raise TypeError(f"state must come from get_state(), got {type(state).__name__}")
    return state


def restored_generator(state: Mapping[str, Any]) -> np.random.Generator:
    """Return a generator with a given state of its bit generator.

    Raises:
        ValueError: It is no such state, or the kind of bit generator is unknown.
    """
    name = state.get("bit_generator") if isinstance(state, Mapping) else None
    if name != "PCG64":
        raise ValueError(unknown("bit generator", name, ["PCG64"]))
    bits: Any = np.random.PCG64(0)
    try:
        bits.state = dict(state)
    except (TypeError, ValueError, KeyError, OverflowError) as error:
        raise damaged(f"generator is no state of a PCG64: {error}") from error
    return np.random.Generator(bits)


def restored_seed(seed: Any) -> int | None:
    """Return the last seed of a generator, or raise ValueError if it is none."""
    if seed is not None and type(seed) is not int:
        raise damaged(f"seed = {seed!r:.80} must be None or a whole number")
    return seed


def _difference(saved: Any, here: Any, path: str = "") -> str:
    """The first value that differs, by its dotted key."""
    if isinstance(saved, Mapping) and isinstance(here, Mapping):
        for key in saved:
            if saved[key] != here.get(key):
                return _difference(saved[key], here.get(key), f"{path}{key}.")
    at = f"{path.rstrip('.')} = " if path else ""
    return f"{at}{saved!r}, here {here!r}"
