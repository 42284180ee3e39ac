"""Many estimators in one compiled call."""

from numbers import Integral
from typing import Any

import numpy as np
from numpy.typing import NDArray

from estimator.estimate import ESTIMATE
from estimator.registry import specification


class BatchEstimator:
    """n independent estimators of one kind; row i of every array is finger i.

    `states` and `estimates` are plain data: `copy()` saves them, assigning to `[:]` restores every bit.

    Attributes:
        parameters: The checked parameter dataclass.
        parameters_array: Structured array (1,), shared by all rows. For parameters of their own put an
            array (n,) of the same dtype in its place and call `reset()`.
        states: Structured array (n,), everything an estimator remembers.
        estimates: Structured array (n,) of dtype ESTIMATE, rewritten by every update.
    """

    def __init__(self, name: str, n: int, **parameters: Any) -> None:
        """See `estimator.make_batch`."""
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

        The hot path: nothing is allocated, nothing validated beyond types and shapes. A row that holds NaN or
        infinity, or whose t is not later than that row's last sample, is skipped: nothing of it changes.

        Args:
            t: Time [s].
            wrenches: (n, 4) float64, C-contiguous: f_x, f_y, f_n, tau [N, N, N, N m] at the CoP.
            twists: (n, 3) float64, C-contiguous: v_x, v_y, omega [m/s, m/s, rad/s] at the CoP.
        """
        n = len(self.states)
        assert wrenches.shape == (n, 4)
        assert twists.shape == (n, 3)
        self._update(self.states, self.parameters_array, t, wrenches, twists, self.estimates)

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
