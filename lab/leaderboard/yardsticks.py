"""Two estimators of one finger as one would write them without a compiler: what ours are timed against."""

from __future__ import annotations

import numpy as np
from filterpy.kalman import MerweScaledSigmaPoints, UnscentedKalmanFilter

from estimator.rls import RlsParameters
from estimator.ukf import UkfParameters, expected, measurement_noise

Pair = tuple[float, float]


class NumpyRls:
    """The motion regime of Waltersson & Karayiannidis (ISER 2025), eqs. (1) and (2), by scalar RLS in numpy.

    No stick-slip machine, no heuristic, no checks: less work than "rls" does, whose defaults it takes.
    """

    def __init__(self) -> None:
        self.p = RlsParameters()
        self.theta = np.array([self.p.mu_c0, self.p.r0])
        self.covariance = np.full(2, self.p.p0)

    def update(self, t: float, wrench: np.ndarray, twist: np.ndarray) -> Pair:
        """Takes one sample, as `OnlineEstimator.update`.

        Returns:
            mu_c [-] and r [m].
        """
        p, f_n = self.p, wrench[2]
        scaled = np.array([np.linalg.norm(twist[:2]), self.theta[1] * np.abs(twist[2])])
        speed = np.linalg.norm(scaled)
        if f_n >= p.eps_fn and speed > p.eps_v:
            gamma_t, gamma_tau = scaled / speed
            if gamma_t > p.eps_t:
                self._step(0, np.linalg.norm(wrench[:2]), gamma_t * f_n, p.mu_min, p.mu_max)
            if gamma_tau > p.eps_tau:
                self._step(1, np.abs(wrench[3]), gamma_tau * self.theta[0] * f_n, p.r_min, p.r_max)
        return float(self.theta[0]), float(self.theta[1])

    def _step(self, i: int, y: np.floating, phi: float, low: float, high: float) -> None:
        """Recursive least squares with forgetting for y = phi theta[i]; P <= P0 against wind-up."""
        denominator = self.p.forgetting + phi * phi * self.covariance[i]
        gain = self.covariance[i] * phi / denominator
        self.theta[i] = np.clip(self.theta[i] + gain * (y - phi * self.theta[i]), low, high)
        self.covariance[i] = min(self.covariance[i] / denominator, self.p.covariance_limit * self.p.p0)


class FilterpyUkf:
    """The model of "ukf" in filterpy's unscented filter, its defaults; learns from every sample it gets.

    alpha 1, beta 0, kappa 1 are the weights 1/3 and 1/6 of Julier & Uhlmann (Proc. IEEE 92, 2004).
    """

    def __init__(self) -> None:
        self.p = UkfParameters()
        self.row = self.p.as_array()[0]
        points = MerweScaledSigmaPoints(2, alpha=1.0, beta=0.0, kappa=1.0)
        self.filter = UnscentedKalmanFilter(2, 2, 1.0, self._measured, lambda x, dt: x, points)
        self.start = np.array([self.p.sd_log_mu_c0, self.p.sd_log_r0]) ** 2
        self.filter.x, self.filter.P = np.log([self.p.mu_c0, self.p.r0]), np.diag(self.start)

    def update(self, t: float, wrench: np.ndarray, twist: np.ndarray) -> Pair:
        """Takes one sample, as `NumpyRls.update`."""
        kalman = self.filter
        f_t, f_n, tau = float(np.hypot(wrench[0], wrench[1])), float(wrench[2]), abs(float(wrench[3]))
        v_t, omega = float(np.hypot(twist[0], twist[1])), abs(float(twist[2]))
        variances = np.diag(kalman.P)
        kalman.Q = np.diag(np.minimum(variances + self.p.drift**2, self.start) - variances)
        kalman.predict()
        a, b = kalman.x
        middle = expected(self.row, a, b, f_n, v_t, omega)
        r_11, r_12, r_22 = measurement_noise(self.row, middle[0], middle[1], a, b, f_n, v_t, omega)
        noise = np.array([[r_11, r_12], [r_12, r_22]])
        kalman.update(np.array([f_t, tau]), noise, f_n=f_n, v_t=v_t, omega=omega)
        mu_c, r = np.exp(kalman.x)
        return float(mu_c), float(r)

    def _measured(self, x: np.ndarray, f_n: float, v_t: float, omega: float) -> np.ndarray:
        return np.array(expected(self.row, x[0], x[1], f_n, v_t, omega))
