"""The table of policies, and how to make one by name."""

import importlib
import inspect
import os
from pathlib import Path
from typing import Any, Protocol

import numpy as np

_CLASSES = {
    "rotational_slip": "policies.rotational_slip:RotationalSlipPolicy",
    "hinge": "policies.hinge:HingePolicy",
    "constant_force": "policies.constant_force:ConstantForcePolicy",
    "planar_slip": "policies.planar_slip:PlanarSlipPolicy",
    "hold": "policies.hold:HoldPolicy",
    "linear_slip": "policies.linear_slip:LinearSlipPolicy",
}
"""Name -> module:class; imported on first use."""


class Policy(Protocol):
    """What acts on observations, as in Stable-Baselines3."""

    @property
    def action_mode(self) -> str:
        """Action mode of the environments it acts in."""
        ...

    def predict(
        self,
        observation: np.ndarray,
        state: Any = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, Any]:
        """Action for an observation (m,) or for a batch of them (n, m), and the memory to pass on.

        Args:
            observation: From the environment.
            state: As returned by the last call; None before the first.
            episode_start: Which rows begin a new episode, (n,) bool.
            deterministic: Whether to act without exploration.
        """
        ...


def names() -> list[str]:
    """Names that `make` knows."""
    return sorted(_CLASSES)


def make(name: str, **parameters: Any) -> Policy:
    """Makes a policy.

    Args:
        name: One of `names()`.
        **parameters: Arguments of the policy's class.

    Raises:
        ValueError: The name or a parameter is unknown, or a value is not allowed.
    """
    if name not in _CLASSES:
        raise ValueError(f"unknown policy {name!r}; valid: {', '.join(names())}")
    module, _, attribute = _CLASSES[name].partition(":")
    policy = getattr(importlib.import_module(module), attribute)
    valid = list(inspect.signature(policy).parameters)
    for parameter in parameters:
        if parameter not in valid:
            raise ValueError(f"unknown parameter {parameter!r} of policy {name!r}; valid: {', '.join(valid)}")
    return policy(**parameters)


def load(path: str | os.PathLike[str]) -> Policy:
    """Loads a trained policy.

    Args:
        path: Where it was saved.

    Raises:
        FileNotFoundError: There is nothing at the path.
        ValueError: What lies there is not a policy that this version can load.
    """
    if not Path(path).exists():
        known = ", ".join(names())
        raise FileNotFoundError(f"no policy at {os.fspath(path)!r}; policies.make knows by name: {known}")
    raise ValueError(f"{os.fspath(path)!r} is not a policy that this version of slipgym can load")
