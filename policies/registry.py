"""The table of policies, and how to make one by name."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from estimator.reference import is_reference
from estimator.suggestions import unknown
from policies.controllers import table as controllers
from policies.learned import LearnedPolicy, pretrained


class Policy(Protocol):
    """Acts on observations, as in Stable-Baselines3."""

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
    """Names that `make` knows: controllers, and the learned policies that come with slipgym."""
    return sorted({*controllers.CLASSES, *pretrained.folders()})


def modes(policy: Any) -> dict[str, Any]:
    """Keyword arguments that an environment for a policy needs.

    Args:
        policy: Anything with a `predict`; it may have `modes`, a mapping of them, or an `action_mode`.
    """
    own = getattr(policy, "modes", None)
    if own is None and hasattr(policy, "action_mode"):
        own = {"action_mode": policy.action_mode}
    return dict(own or {})


def check_estimates(name: object, policy: Any, arguments: Mapping[str, Any]) -> None:
    """Refuse a controller that acts on estimates in an environment that has none.

    Args:
        name: What the policy was made by.
        policy: The policy.
        arguments: Keyword arguments of the environment.

    Raises:
        ValueError: It is such a controller, and the environment has `estimator=None`.
    """
    source, estimator = arguments.get("friction_source", "estimated"), arguments.get("estimator", "")
    if source == "estimated" and estimator is None and getattr(policy, "acts_on_friction", False):
        called = repr(name) if isinstance(name, str) else type(policy).__name__
        raise ValueError(
            f"controller {called} acts on estimates: this environment has estimator=None; choose an "
            "estimator, or friction_source 'true' or 'nominal'"
        )


def find(name: str) -> type[Policy]:
    """The class of a policy.

    Args:
        name: One of `names()`, or "module:class" for one of your own: any class with a `predict`.

    Raises:
        ValueError: There is none.
    """
    return controllers.find(name, names())


def make(name: str, **parameters: Any) -> Policy:
    """Makes a policy.

    Args:
        name: As for `find`, or that of a learned policy that comes with slipgym.
        **parameters: Arguments of the policy's class; learned policies have none.

    Raises:
        ValueError: The name or a parameter is unknown, or a value is not allowed.
    """
    if name in pretrained.folders():
        controllers.refuse(name, parameters, [])
        return LearnedPolicy(pretrained.folders()[name])
    return controllers.make(name, parameters, names())


def load(which: str | os.PathLike[str], **parameters: Any) -> Policy:
    """Loads a policy; nothing that lies in its files is executed.

    Args:
        which: One of `names()`, or the folder of a learned policy (docs/policy_files.md).
        **parameters: As for `make`.

    Raises:
        FileNotFoundError: It is no name, and there is nothing at the path.
        ValueError: What lies there is not a policy that this version can load, or not whole; or a
            parameter is unknown.
    """
    if which in names() or (isinstance(which, str) and is_reference(which)):
        return make(str(which), **parameters)
    if not Path(which).exists():
        raise FileNotFoundError(unknown("no policy at", os.fspath(which), names()))
    controllers.refuse(os.fspath(which), parameters, [])
    return LearnedPolicy(which)
