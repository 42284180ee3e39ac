"""Complete states of environments as plain data, with a checksum of each of their fields."""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cache
from typing import Any, TypeVar

import numpy as np

from slipgym.config.errors import unknown
from slipgym.version import __version__
from slipgym.world.plant import Plant
from slipgym.world.scene import Box, EngineState


@dataclass(frozen=True)
class SimulationState:
    """State of a `Simulation` between two control steps."""

    engine: EngineState | None
    """Bodies in PyBullet; None for the planar engine."""
    plant: Plant
    """Worlds, pads, fingers and sensors."""
    arrays: Mapping[str, np.ndarray]
    """Estimators, episodes, and their last outputs, by name."""
    materials: list[str]
    """Name of every episode's material."""
    boxes: list[Box]
    """Every episode's object."""


@dataclass(frozen=True)
class State:
    """Base class of the states: the environment that a state belongs to, and the checksums."""

    made_of: Mapping[str, Any]
    """Task, configuration and arguments that the environment was made with."""
    version: str = field(default=__version__, kw_only=True)
    """Version of slipgym that wrote it."""
    sums: Mapping[str, int] = field(default_factory=dict, kw_only=True)
    """CRC-32 of every other part by its dotted name; computed unless given."""

    def __post_init__(self) -> None:
        if not self.sums:
            object.__setattr__(self, "sums", self._sums())

    def check(self, made_of: Mapping[str, Any]) -> None:
        """Raise ValueError unless the state is whole, and of an environment with the same arguments.

        Args:
            made_of: Task, configuration and arguments of the environment that restores the state.

        Raises:
            ValueError: Version, task, configuration or arguments differ, or something in the state is not as
                `get_state` wrote it; the message names the first.
        """
        if self.version != __version__:
            raise ValueError(f"the state is of slipgym {self.version!s:.20}, this is {__version__}")
        if not isinstance(self.made_of, Mapping) or not made_of.keys() <= self.made_of.keys():
            raise damaged(f"made_of must be a mapping with the keys {', '.join(made_of)}")
        for name, value in made_of.items():
            if self.made_of[name] != value:
                difference = _difference(self.made_of[name], value)
                raise ValueError(
                    f"the state is of an environment with another {name}: {difference}; "
                    "make one with the same arguments"
                )
        written = dict(self.sums) if isinstance(self.sums, Mapping) else {}
        if (found := self._sums()) != written:
            name = min((name for name in found if written.get(name) != found[name]), default="sums")
            _refuse_nan(name, dict(_parts(self)).get(name))
            raise damaged(f"{name} is not as get_state() wrote it")

    def _sums(self) -> dict[str, int]:
        return {name: _checksum(part) for name, part in _parts(self)}


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


def damaged(what: str) -> ValueError:
    """The error for a state that is not as an environment wrote it."""
    return ValueError(f"the state is damaged: {what}")


def check_layout(given: SimulationState, own: SimulationState, ready: np.ndarray) -> None:
    """Check that a state fits an environment: dtypes and shapes of all arrays, and that none holds NaN.

    Args:
        given: A state that is whole.
        own: What the environment has.
        ready: Environments that have an episode in the state, (n,) bool; numbers of the others do not count.

    Raises:
        ValueError: An array is missing or another one, or holds NaN.
    """
    found, mine = (
        {name: part for name, part in _parts(state) if isinstance(part, np.ndarray)} for state in (given, own)
    )
    for name in sorted(found.keys() | mine.keys()):
        there, here = found.get(name), mine.get(name)
        if there is None or here is None:
            raise damaged(f"{name} is missing" if there is None else f"the environment has no {name}")
        if there.dtype != here.dtype or there.shape != here.shape:
            kinds = "records of another kind" if there.dtype.names else there.dtype.name
            raise damaged(f"{name} has {kinds}, shape {there.shape}; the environment has {here.shape}")
        if not name.startswith(_ESTIMATORS):
            _refuse_nan(name, there[np.repeat(ready, len(there) // len(ready))])


_ESTIMATORS = "arrays.estimator_"
"""States and parameters of estimators, where NaN may say that there is no number yet."""


def _refuse_nan(name: str, part: Any) -> None:
    """Raise ValueError if an array holds NaN; of records, the message names the field."""
    if isinstance(part, np.ndarray):
        for key in part.dtype.names or ("",):
            numbers = part[key] if key else part
            if numbers.dtype.kind == "f" and np.isnan(numbers).any():
                raise damaged(f"{name}{'.' * bool(key)}{key} holds a number that is not finite")


def restored_generator(state: Mapping[str, Any]) -> np.random.Generator:
    """Return a generator with a given state of its bit generator.

    Raises:
        ValueError: The kind of bit generator is unknown.
    """
    name = state.get("bit_generator")
    if name != "PCG64":
        raise ValueError(unknown("bit generator", name, ["PCG64"]))
    bits: Any = np.random.PCG64(0)
    bits.state = dict(state)
    return np.random.Generator(bits)


def _parts(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Parts of a state with their dotted names, but for `State.made_of` and `State.sums`."""
    if is_dataclass(value):
        names = [each.name for each in fields(value) if each.name not in ("made_of", "sums")]
        inner = {name: getattr(value, name) for name in names}
    elif isinstance(value, Mapping) and any(isinstance(each, np.ndarray) for each in value.values()):
        inner = value
    else:
        yield path, value
        return
    for name, part in inner.items():
        yield from _parts(part, f"{path}.{name}" if path else str(name))


def _checksum(part: Any) -> int:
    if isinstance(part, np.ndarray) and not part.dtype.hasobject:
        content, used = np.ascontiguousarray(part).reshape(-1).view(np.uint8), _used(part.dtype)
        if not used.all():
            content = np.compress(used, content.reshape(-1, len(used)), axis=1)
        return zlib.crc32(content.data, zlib.crc32(f"{part.dtype.kind}{part.shape}".encode()))
    return zlib.crc32(part if isinstance(part, bytes) else repr(part).encode())


@cache
def _used(dtype: np.dtype) -> np.ndarray:
    """Bytes of a record that belong to a field; the others need not survive copies."""
    used = np.full(dtype.itemsize, dtype.names is None)
    for kind, offset, *_ in (dtype.fields or {}).values():
        used[offset : offset + kind.itemsize] = True
    return used


def _difference(saved: Any, here: Any, path: str = "") -> str:
    """The first value that differs, by its dotted key."""
    if isinstance(saved, Mapping) and isinstance(here, Mapping):
        for key in saved:
            if saved[key] != here.get(key):
                return _difference(saved[key], here.get(key), f"{path}{key}.")
    at = f"{path.rstrip('.')} = " if path else ""
    return f"{at}{saved!r}, here {here!r}"
