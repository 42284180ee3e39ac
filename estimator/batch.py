"""Many estimators in one compiled call."""

from numbers import Integral
from typing import Any

import numpy as np
from numpy.typing import NDArray

from estimator.estimate import ESTIMATE
from estimator.registry import FilterMatrices, specification


class BatchEstimator:
    """n independent estimators of one kind; row i of every array is finger i.

    `states` and `estimates` are plain data: `copy()` saves them, assigning to `[:]` restores every bit.

    Attributes:
        name: The name that `estimator.make` knows it by.
        parameters: The checked parameter dataclass.
        parameters_array: Structured array (1,), shared by all rows. For different parameters in each row put
            an array (n,) of the same dtype in its place and call `reset()`.
        states: Structured array (n,), all memory of the estimators.
        estimates: Structured array (n,) of dtype ESTIMATE, rewritten by every update.
    """

    def __init__(self, name: str, n: int, **parameters: Any) -> None:
        """See `estimator.make_batch`."""
        self.name = name
        self._specification = specification(name)
        if isinstance(n, bool) or not isinstance(n, Integral) or n < 1:
            raise ValueError(f"n = {n!r}: expected an integer in [1, inf)")
        self._update = self._specification.update_batch
        self.parameters = self._specification.parameters.create(**parameters)
        self.parameters_array = self.parameters.as_array()
        self.states = np.repeat(self._specification.initial_states(self.parameters_array), n)
        self.estimates = np.zeros(n, ESTIMATE)
        self.reset()

    def update(self, t: float, wrenches: NDArray[np.float64], twists: NDArray[np.float64]) -> None:
        """Takes one sample of every finger; results are in `estimates`.

        This is the hot path: it allocates nothing and checks only types and shapes. A row that holds NaN or
        a reading of 1e12 or more, or whose t is not later than the last sample of that row, stays as it
        is.

        Args:
            t: Time [s].
            wrenches: (n, 4) float64, C-contiguous: f_x, f_y, f_n, tau [N, N, N, N m] at the CoP.
            twists: (n, 3) float64, C-contiguous: v_x, v_y, omega [m/s, m/s, rad/s] at the CoP.

        Raises:
            TypeError: They are no such arrays, or t is no number.
            ValueError: A shape is another one.
        """
        n = len(self.states)
        if getattr(wrenches, "shape", None) != (n, 4) or getattr(twists, "shape", None) != (n, 3):
            raise ValueError(f"expected {_WANTED.format(n)}, got {_kind(wrenches)} and {_kind(twists)}")
        try:
            self._update(self.states, self.parameters_array, t, wrenches, twists, self.estimates)
        except TypeError as error:  # numba's
            given = f"{_kind(wrenches)} and {_kind(twists)} at t = {t!r:.40}"
            raise TypeError(f"expected {_WANTED.format(n)} at a number t [s], got {given}") from error

    def reset(self, indices: Any = None) -> None:
        """Returns rows to their start values.

        Args:
            indices: Any numpy index of rows; None for all.
        """
        rows = slice(None) if indices is None else indices
        own = self.parameters_array[rows] if len(self.parameters_array) > 1 else self.parameters_array
        self.states[rows] = self._specification.initial_states(own)
        self.estimates[rows] = np.zeros((), ESTIMATE)
        for name in ("mu_s", "mu_c", "r"):
            self.estimates[name][rows] = self.states[name][rows]
            self.estimates[f"sd_{name}"][rows] = self.states[name][rows]
        self.estimates["sd_lever"][rows] = 2**0.5 * self.states["mu_c"][rows] * self.states["r"][rows]
        self.estimates["mu_s"][rows] = np.maximum(self.states["mu_s"][rows], self.states["mu_c"][rows])

    @property
    def matrices(self) -> FilterMatrices:
        """Residual, gain, covariance and innovation covariance of the filters, copied.

        Shapes and units are those of `FilterMatrices`; an entry is None if this estimator does not have it.
        """
        found = self._specification.filter_matrices
        return FilterMatrices() if found is None else found(self.states)

    def __len__(self) -> int:
        return len(self.states)

    def __repr__(self) -> str:
        changed = "".join(f", {name}={value!r}" for name, value in self.parameters.changed().items())
        lines = [f"BatchEstimator({self.name!r}, n={len(self)}{changed})"]
        if len(self.parameters_array) > 1:
            lines.append("  parameters: different in each row")
        for name, unit in (("mu_s", ""), ("mu_c", ""), ("r", " m")):
            values, confidence = self.estimates[name], self.estimates[f"confidence_{name}"]
            lines.append(
                f"  {name:<4}  {np.median(values):.4g}{unit} ({values.min():.4g} to {values.max():.4g}), "
                f"confidence {np.median(confidence):.2f} ({confidence.min():.2f} to {confidence.max():.2f})"
            )
        slipping, halted = self.estimates["slipping"].sum(), self.estimates["halted"].sum()
        lines.append(f"  slipping {slipping}, halted {halted} of {len(self)}; values are medians (range)")
        return "\n".join(lines)


_WANTED = "C-contiguous float64 arrays wrenches ({0}, 4) and twists ({0}, 3)"


def _kind(array: Any) -> str:
    if not isinstance(array, np.ndarray):
        return f"a {type(array).__name__}"
    return f"{'' if array.flags.c_contiguous else 'not contiguous '}{array.dtype} {array.shape}"


def make_batch(name: str, n: int, **parameters: Any) -> BatchEstimator:
    """Makes n independent estimators that one compiled call updates together.

    Args:
        name: One of `estimator.names()`, or "module:attribute" for your own Specification.
        n: Number of fingers.
        **parameters: As for `estimator.make`; all n share them.

    Raises:
        ValueError: As for `estimator.make`, or n is not a positive integer.
    """
    return BatchEstimator(name, n, **parameters)
