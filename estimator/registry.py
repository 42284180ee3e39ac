"""The table of estimators, and how to make one by name."""

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from estimator.parameters import Parameters
from estimator.reference import is_reference, referenced

if TYPE_CHECKING:
    from estimator.batch import BatchEstimator
    from estimator.online import OnlineEstimator

_MODULES = {name: f"estimator.{name}.specification" for name in ("disc", "joint", "rls", "ukf")}
"""Name -> module that holds its SPECIFICATION; imported on first use, because numba is slow to import."""


@dataclass(frozen=True)
class Specification:
    """What makes an estimator."""

    name: str
    """Name that `make` knows it by."""
    parameters: type[Parameters]
    """Its parameter dataclass."""
    initial_states: Callable[[NDArray[np.void]], NDArray[np.void]]
    """parameters (m,) -> states (m,) before the first sample; the state dtype begins with COMMON_STATE."""
    update_batch: Callable[..., None]
    """Compiled: (states (n,), parameters (1,) or (n,), t, wrenches (n, 4), twists (n, 3), estimates (n,))."""

    def __reduce__(self) -> tuple[Any, ...]:
        return specification, (self.name,)


def names() -> list[str]:
    """Names that `make` and `make_batch` know."""
    return sorted(_MODULES)


def specification(name: str) -> Specification:
    """Looks an estimator up.

    Args:
        name: One of `names()`, or "module:attribute" for a Specification of your own that has it as its name.

    Raises:
        ValueError: No estimator has this name.
    """
    if is_reference(name):
        found = referenced(name)
        if not isinstance(found, Specification) or found.name != name:
            raise ValueError(f"{name!r} is no Specification of this name")
        return found
    if name not in names():
        raise ValueError(f"unknown estimator {name!r}; valid: {', '.join(names())}")
    return importlib.import_module(_MODULES[name]).SPECIFICATION


def make(name: str, **parameters: Any) -> "OnlineEstimator":
    """Makes the estimator of one finger.

    Args:
        name: As for `specification`.
        **parameters: Fields of its parameter dataclass, for example `RlsParameters`.

    Raises:
        ValueError: The name or a parameter is unknown, or a value is of the wrong type or out of range.
    """
    from estimator.online import OnlineEstimator

    return OnlineEstimator(name, **parameters)


def make_batch(name: str, n: int, **parameters: Any) -> "BatchEstimator":
    """Makes n independent estimators that one compiled call updates together.

    Args:
        name: As for `specification`.
        n: How many fingers.
        **parameters: As for `make`; all n share them.

    Raises:
        ValueError: As for `make`, or n is not a positive integer.
    """
    from estimator.batch import BatchEstimator

    return BatchEstimator(name, n, **parameters)
