"""The table of estimators: what makes an estimator, and how to look one up by name."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from estimator.parameters import Parameters
from estimator.reference import is_reference, referenced
from estimator.suggestions import asking

DEFAULT = "adaptive"
"""Name of the default estimator, also of the environments (docs/leaderboard.md compares them)."""

_NAMES = "adaptive", "disc", "joint", "rls", "ukf"
"""Modules that hold a SPECIFICATION; imported on first use, because numba is slow to import."""


class FilterMatrices(NamedTuple):
    """Matrices of n filters; None for what an estimator does not have.

    The units are those of the estimator: its module and docs/estimator.md give them.
    """

    residual: NDArray[np.float64] | None = None
    """y, innovation of (f_t, |tau|) at the last update, (n, 2) [N, N m]; 0 before the first update."""
    gain: NDArray[np.float64] | None = None
    """K of the last update, (n, 2, 2): rows mu_c and r, columns f_t and |tau|; 0 before the first update."""
    covariance: NDArray[np.float64] | None = None
    """P of (mu_c, r) after the last update, (n, 2, 2)."""
    innovation_covariance: NDArray[np.float64] | None = None
    """S of the residual at the last update, (n, 2, 2) [N^2, N^2 m, N^2 m^2]; 0 before the first update."""


@dataclass(frozen=True)
class Specification:
    """An estimator: its parameters, initial states and update."""

    name: str
    """Name that `make` knows it by."""
    parameters: type[Parameters]
    """Its parameter dataclass."""
    initial_states: Callable[[NDArray[np.void]], NDArray[np.void]]
    """parameters (m,) -> states (m,) before the first sample; the state dtype begins with COMMON_STATE."""
    update_batch: Callable[..., None]
    """Compiled: (states, parameters, t, wrenches, twists, estimates); updates n fingers by one sample each.

    The states (n,) and the estimates (n,) of dtype ESTIMATE are written. The parameters are (1,), shared, or
    (n,); t is the time [s]; wrenches (n, 4) hold f_x, f_y, f_n, tau [N, N, N, N m] and twists (n, 3) hold
    v_x, v_y, omega [m/s, m/s, rad/s], both at the CoP. A row with NaN or a reading from
    `estimator.sample.LARGEST` on, or whose t is not later than its last, is left unchanged.
    """
    filter_matrices: Callable[[NDArray[np.void]], FilterMatrices] | None = None
    """states (n,) -> matrices of the filters; None: it has no such matrices."""

    def __reduce__(self) -> tuple[Any, ...]:
        return specification, (self.name,)


def names() -> list[str]:
    """Names that `make` and `make_batch` know."""
    return list(_NAMES)


def specification(name: str) -> Specification:
    """Looks an estimator up.

    Args:
        name: One of `names()`, or "module:attribute" for your own Specification, which must have this name.

    Raises:
        ValueError: No estimator has this name, or it is part of the laboratory.
    """
    if is_reference(name):
        found = referenced(name)
        if not isinstance(found, Specification) or found.name != name:
            raise ValueError(f"{name!r} is no Specification of this name")
        return found
    if name == "gru":
        raise ValueError(
            '"gru" is part of the laboratory: use "lab.learned_estimator.gru:SPECIFICATION" in a clone'
        )
    if name not in _NAMES:
        raise ValueError(asking(f"unknown estimator {name!r}; valid: {', '.join(_NAMES)}", name, _NAMES))
    return referenced(f"estimator.{name}:SPECIFICATION")
