"""Parameters of the "joint" estimator."""

from dataclasses import dataclass

from estimator.parameters import parameter
from estimator.sliding.parameters import SlidingParameters


@dataclass(frozen=True)
class JointParameters(SlidingParameters):
    """Those of every estimator that learns from true sliding, and its own.

    Each field's metadata holds its documentation, unit and valid interval.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    pivot_limit: float = parameter(
        3.0, "Largest distance v_t / omega of the centre of rotation for r, in pad radii.", "(0, inf)"
    )
    sd_viscosity: float = parameter(
        0.2, "Spread of the viscous friction, about zero, before it is seen.", "(0, inf)", "s/m"
    )
    sd_mu_c0: float = parameter(1.0, "Standard deviation of mu_c0.", "(0, inf)")
    sd_r0: float = parameter(0.01, "Standard deviation of r0.", "(0, inf)", "m")
