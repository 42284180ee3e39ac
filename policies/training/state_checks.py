"""Turns what a learner holds into plain data and back, and checks it before anything of it is used."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
import torch
from stable_baselines3.common.running_mean_std import RunningMeanStd


def arrays(value: Any) -> Any:
    """A tree whose tensors are arrays of numpy, marked as such."""
    if isinstance(value, torch.Tensor):
        return {"tensor": value.detach().cpu().numpy().copy()}
    return _mapped(arrays, value)


def tensors(value: Any) -> Any:
    """The reverse of `arrays`."""
    if isinstance(value, dict) and set(value) == {"tensor"}:
        return torch.from_numpy(value["tensor"].copy())
    return _mapped(tensors, value)


def _mapped(change: Any, value: Any) -> Any:
    if isinstance(value, dict):
        return {key: change(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return (list if isinstance(value, list) else tuple)(map(change, value))
    return value


def moments(rms: RunningMeanStd) -> dict[str, Any]:
    """Mean, variance and count as plain data."""
    return {"mean": np.array(rms.mean), "var": np.array(rms.var), "count": float(rms.count)}


def set_moments(rms: RunningMeanStd, state: Mapping[str, Any]) -> None:
    """Go on from moments."""
    rms.mean, rms.var, rms.count = np.array(state["mean"]), np.array(state["var"]), state["count"]


@contextmanager
def fits(what: str) -> Iterator[None]:
    """Turn whatever a state of another shape raises into one ValueError that names the state."""
    try:
        yield
    except OSError:
        raise
    except Exception as error:  # code that reads a tree of another shape than it wrote raises anything
        message = str(error).partition("\n")[0]
        raise ValueError(f"{what} does not fit this run: {type(error).__name__}: {message:.200}") from error


def check_like(name: str, given: Any, own: Any) -> None:
    """Raise ValueError unless a tree has the shape of one's own, and all its numbers are finite.

    A tree is of mappings, lists, tuples, arrays, numbers and texts; None in one's own stands for any value.
    """
    if isinstance(given, np.ndarray):
        if isinstance(own, np.ndarray) and (given.shape, given.dtype.kind) != (own.shape, own.dtype.kind):
            raise ValueError(f"{name} must be an array {own.shape} of {own.dtype.name}")
        if given.dtype.kind == "f" and not np.isfinite(given).all():
            raise ValueError(f"{name} holds a number that is not finite")
    if own is not None and not _same_kind(given, own):
        raise ValueError(f"{name} = {given!r:.40} must be of the kind of {own!r:.40}")
    pairs: Any = ()
    if isinstance(given, Mapping):
        pairs = given.items()
    elif isinstance(given, list | tuple):
        pairs = enumerate(given)
    for key, each in pairs:
        check_like(f"{name}.{key}", each, own[key] if own else None)


def _same_kind(given: Any, own: Any) -> bool:
    if isinstance(own, Mapping):
        return isinstance(given, Mapping) and given.keys() == own.keys()
    if isinstance(own, list | tuple):
        return type(given) is type(own) and len(given) == len(own)
    if isinstance(own, str):
        return given == own
    return type(given) is type(own) or {type(given), type(own)} == {int, float}
