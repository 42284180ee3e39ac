"""The estimator of one finger, with checked inputs."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from estimator.batch import BatchEstimator
from estimator.estimate import Estimate
from estimator.parameters import Parameters
from estimator.reasons import doubts, reasons

WRENCH = ("f_x", "f_y", "f_n", "tau")
TWIST = ("v_x", "v_y", "omega")
_NUMBERS = (float, int, np.floating, np.integer)


def _fill(row: NDArray[np.float64], values: Any, what: str, components: Sequence[str]) -> None:
    """Copies finite numbers into a row; a flat sequence, the usual case, is tried first for speed."""
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

    `residual`, `gain`, `covariance` and `innovation_covariance` are y, K, P and S of a recursive filter: new
    arrays with the values of the last update, or None if the estimator does not have them.

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
    def name(self) -> str:
        """The name that `estimator.make` knows it by."""
        return self.batch.name

    @property
    def parameters(self) -> Parameters:
        """The checked parameters."""
        return self.batch.parameters

    @property
    def estimate(self) -> Estimate:
        """The newest estimate; the start values before the first sample."""
        return Estimate._make(self.batch.estimates.item())

    @property
    def residual(self) -> NDArray[np.float64] | None:
        """y, innovation of (f_t, |tau|) at the last update, (2,) [N, N m]; 0 before the first update.

        "rls" and "ukf" have it.
        """
        return _first(self.batch.matrices.residual)

    @property
    def gain(self) -> NDArray[np.float64] | None:
        """K of the last update, (2, 2); rows mu_c and r, columns f_t and |tau|; 0 before the first update.

        "rls": diagonal [1/N]. "ukf": of (ln mu_c, ln r), columns in [1/N] and [1/(N m)].
        """
        return _first(self.batch.matrices.gain)

    @property
    def covariance(self) -> NDArray[np.float64] | None:
        """P of (mu_c, r) after the last update, (2, 2).

        "rls": diagonal, without the variance of the noise [1/N^2]. "ukf" and "adaptive": of (ln mu_c, ln r)
        [-]. "joint" and "disc": diagonal [1, m^2], because mu_c and r are averaged separately.
        """
        return _first(self.batch.matrices.covariance)

    @property
    def innovation_covariance(self) -> NDArray[np.float64] | None:
        """S, covariance of the residual, (2, 2) [N^2, N^2 m, N^2 m^2]; only "ukf" has it."""
        return _first(self.batch.matrices.innovation_covariance)

    def update(self, t: float, wrench: ArrayLike, twist: ArrayLike) -> Estimate:
        """Takes one sample.

        Call it once per sample of the slip-velocity sensor (nominally 120 Hz) with the newest force. Only
        magnitudes enter, so the sign convention and the mirroring of the second finger do not matter;
        "adaptive" uses directions, too, and needs force and velocity in one frame.

        Args:
            t: Time [s], later than that of the last sample.
            wrench: (f_x, f_y, f_n, tau) [N, N, N, N m] at the centre of pressure (CoP).
            twist: (v_x, v_y, omega) [m/s, m/s, rad/s] of the slip at the CoP.

        A sample with a reading of 1e12 or more, which no sensor gives, is skipped.

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

    def reasons(self) -> dict[str, str]:
        """Reasons for little confidence in values of the newest estimate, as by `estimator.reasons`."""
        return reasons(self.estimate, *doubts(self.batch.states[0]))

    def reset(self) -> None:
        """Returns to the start values and forgets every sample."""
        self.batch.reset()

    def __repr__(self) -> str:
        e = self.estimate
        changed = "".join(f", {name}={value!r}" for name, value in self.parameters.changed().items())
        samples = int(self._samples[0])
        when = f"{samples} samples, the last at t = {self._t[0]:.6g} s" if samples else "no samples"
        lines = [
            f"OnlineEstimator({self.name!r}{changed})",
            f"  mu_s  {e.mu_s:.4g}, sd {e.sd_mu_s:.2g}, confidence {e.confidence_mu_s:.2f}",
            f"  mu_c  {e.mu_c:.4g}, sd {e.sd_mu_c:.2g}, confidence {e.confidence_mu_c:.2f}",
            f"  r     {e.r:.4g} m, sd {e.sd_r:.2g} m, confidence {e.confidence_r:.2f}",
            f"  slipping {e.slipping}, halted {e.halted}, {when}",
        ]
        for name, matrix in self.batch.matrices._asdict().items():
            if matrix is not None:
                lines.append(f"  {name} {np.array2string(matrix[0], precision=3).replace(chr(10), '')}")
        return "\n".join(lines)


def _first(matrices: NDArray[np.float64] | None) -> NDArray[np.float64] | None:
    return None if matrices is None else matrices[0]


def make(name: str, **parameters: Any) -> OnlineEstimator:
    """Makes the estimator of one finger.

    Args:
        name: One of `estimator.names()`, or "module:attribute" for your own Specification.
        **parameters: Fields of its parameter dataclass, for example `RlsParameters`.

    Raises:
        ValueError: The name or a parameter is unknown, or a value is of the wrong type or out of range.
    """
    return OnlineEstimator(name, **parameters)
