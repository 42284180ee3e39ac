"""Parameters of the "ukf" estimator."""

from dataclasses import dataclass

from estimator.parameters import parameter
from estimator.sliding.parameters import SlidingParameters


@dataclass(frozen=True)
class UkfParameters(SlidingParameters):
    """Those of every estimator that learns from true sliding, and its own.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    disc: bool = parameter(
        True, "Whether the limit surface is that of a uniform disc; otherwise it is the ellipsoid."
    )
    drift: float = parameter(
        1e-3, "Relative random walk of mu_c and of r per sample of sliding, standard deviation.", "(0, 1)"
    )
    sd_log_mu_c0: float = parameter(1.0, "Standard deviation of ln mu_c at the start.", "(0, 3]")
    sd_log_r0: float = parameter(1.0, "Standard deviation of ln r at the start.", "(0, 3]")
