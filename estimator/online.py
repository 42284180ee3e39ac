"""The estimator of one finger, with checked inputs."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from estimator.batch import BatchEstimator
from estimator.estimate import Estimate
from estimator.parameters import Parameters

WRENCH = ("f_x", "f_y", "f_n", "tau")
TWIST = ("v_x", "v_y", "omega")
_NUMBERS = (float, int, np.floating, np.integer)


def _fill(row: NDArray[np.float64], values: Any, what: str, components: Sequence[str]) -> None:
    """Copies finite numbers into a row; the usual case, a flat sequence, is tried first: that is quick."""
    try:
        listed = values.tolist() if isinstance(values, np.ndarray) else values
        plain = len(listed) == len(components) and math.isfinite(sum(listed))
        if plain:
            row[:] = listed
    except (TypeError, ValueError, OverflowError):
        plain = False
    if plain:
        return
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        array = None
    if array is None or array.shape != row.shape:
        shape = "not numbers" if array is None else f"shape {array.shape}"
        raise ValueError(f"{what}: expected ({', '.join(components)}), got {shape}")
    for component, value in zip(components, array.tolist(), strict=True):
        if not math.isfinite(value):
            raise ValueError(f"{what}: {component} = {value}: expected a finite number")
    row[:] = array


class OnlineEstimator:
    """Estimates the contact properties of one finger, sample by sample.

    Attributes:
        batch: The one-row `BatchEstimator` inside; its `states` and `estimates` save and restore this object.
    """

    def __init__(self, name: str, **parameters: Any) -> None:
        """See `estimator.make`."""
        self.__setstate__(BatchEstimator(name, 1, **parameters))

    def __getstate__(self) -> Any:
        return self.batch

    def __setstate__(self, batch: BatchEstimator) -> None:
        self.batch = batch
        self._samples, self._t = batch.states["samples"], batch.states["t"]  # views, as long as the states
        self._wrenches, self._twists = np.zeros((1, 4)), np.zeros((1, 3))
        self._wrench, self._twist = self._wrenches[0], self._twists[0]

    @property
    def parameters(self) -> Parameters:
        """The checked parameters."""
        return self.batch.parameters

    @property
    def estimate(self) -> Estimate:
        """The newest estimate; the start values before the first sample."""
        return Estimate._make(self.batch.estimates.item())

    def update(self, t: float, wrench: ArrayLike, twist: ArrayLike) -> Estimate:
        """Takes one sample.

        Call it once per slip-velocity sample (nominally 120 Hz) with the newest force. Only magnitudes enter,
        so the sign convention and the mirroring of the second finger do not matter.

        Args:
            t: Time [s], later than the last sample's.
            wrench: (f_x, f_y, f_n, tau) [N, N, N, N m] at the centre of pressure (CoP).
            twist: (v_x, v_y, omega) [m/s, m/s, rad/s] of the slip at the CoP.

        Raises:
            ValueError: t does not increase, or an input is not finite or of the wrong shape; nothing changes.
        """
        if not isinstance(t, _NUMBERS) or not math.isfinite(t):
            raise ValueError(f"t = {t!r}: expected a finite number [s]")
        if self._samples[0] and t <= self._t[0]:
            raise ValueError(f"t = {t!r}: expected later than the last sample's {self._t[0]} s")
        _fill(self._wrench, wrench, "wrench", WRENCH)
        _fill(self._twist, twist, "twist", TWIST)
        self.batch.update(float(t), self._wrenches, self._twists)
        return self.estimate

    def reset(self) -> None:
        """Returns to the start values and forgets every sample."""
        self.batch.reset()
