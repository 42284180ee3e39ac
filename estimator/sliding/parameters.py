"""Parameters of estimators that learn from each instant of true sliding."""

from dataclasses import dataclass

from estimator.parameters import parameter
from estimator.sliding.state import DELAY_MAX
from estimator.stick_slip.parameters import StickSlipParameters
from estimator.stick_slip.state import BUFFER_CAPACITY


@dataclass(frozen=True)
class SlidingParameters(StickSlipParameters):
    """Table 1 of Waltersson & Karayiannidis (ISER 2025) where shared; the noise is a realistic sensor's.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    disc: bool = parameter(
        False, "Whether the limit surface is that of a uniform disc; otherwise it is the ellipsoid."
    )
    heuristic: bool = parameter(
        False, "Whether a fast rise of f_n halts all updates; the test of sliding makes it unnecessary."
    )
    r0: float = parameter(
        0.01, "Start value of r: that of a uniform disc as large as the pad.", "(0, inf)", "m"
    )
    r_max: float = parameter(0.015, "Radius of the pad: r is kept at or below this.", "(0, inf)", "m")
    n_a: int = parameter(
        1, "How many of the largest buffered ratios are averaged to mu_s.", f"[1, {BUFFER_CAPACITY}]"
    )
    gain_mu_s: float = parameter(
        0.2, "Weight of a new event in mu_s, once 1 / gain_mu_s events have been averaged.", "(0, 1]"
    )
    jump_mu_s: float = parameter(
        0.15, "Relative change, if above three deviations too, at which mu_s starts afresh.", "(0, inf]"
    )
    velocity_delay: int = parameter(
        1, "Age of the velocity in samples: how long ago its window closed.", f"[0, {DELAY_MAX}]"
    )

    noise_gate: float = parameter(
        2.0, "How many of its standard deviations a signal must exceed to count.", "(0, inf)"
    )
    sd_force: float = parameter(0.02, "Standard deviation of f_t.", "(0, inf)", "N")
    sd_normal: float = parameter(0.04, "Standard deviation of f_n.", "(0, inf)", "N")
    sd_torque: float = parameter(5e-4, "Standard deviation of tau.", "(0, inf)", "N m")
    sd_speed: float = parameter(1.6e-4, "Standard deviation of v_t.", "(0, inf)", "m/s")
    sd_spin: float = parameter(6.5e-3, "Standard deviation of omega.", "(0, inf)", "rad/s")
    law_error: float = parameter(
        0.02, "Relative error of the friction law in a sample, as if it were white.", "[0, inf)"
    )
