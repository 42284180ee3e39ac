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


def _fill(row: NDArray[np.float64], values: ArrayLike, what: str, components: Sequence[str]) -> None:
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
        self.batch = BatchEstimator(name, 1, **parameters)
        self._wrenches = np.zeros((1, 4))
        self._twists = np.zeros((1, 3))

    @property
    def parameters(self) -> Parameters:
        """The checked parameters."""
        return self.batch.parameters

    @property
    def estimate(self) -> Estimate:
        """The newest estimate; the start values before the first sample."""
        return Estimate(*self.batch.estimates[0].item())

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
        state = self.batch.states[0]
        if not isinstance(t, float | int | np.floating | np.integer) or not math.isfinite(t):
            raise ValueError(f"t = {t!r}: expected a finite number [s]")
        if state["samples"] and t <= state["t"]:
            raise ValueError(f"t = {t!r}: expected later than the last sample's {state['t']} s")
        _fill(self._wrenches[0], wrench, "wrench", WRENCH)
        _fill(self._twists[0], twist, "twist", TWIST)
        self.batch.update(float(t), self._wrenches, self._twists)
        return self.estimate

    def reset(self) -> None:
        """Returns to the start values and forgets every sample."""
        self.batch.reset()
