"""Declares the parameters of "adaptive": what a data sheet or a careful user says, and nothing else."""

from dataclasses import dataclass

from estimator.parameters import RADIUS, Parameters, parameter

EARLIEST, LATEST = -1, 5  # Delays of the velocity [samples]; negative: the force itself is late


@dataclass(frozen=True)
class AdaptiveParameters(Parameters):
    """Noise of the sensors, limits, start values with their spreads, the pad and the memory.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    sd_force: float = parameter(0.02, "Standard deviation of f_x and f_y.", "(0, inf)", "N")
    sd_normal: float = parameter(0.04, "Standard deviation of f_n.", "(0, inf)", "N")
    sd_torque: float = parameter(5e-4, "Standard deviation of tau.", "(0, inf)", "N m")
    resolution: float = parameter(1e-5, "Displacement of one count of the slip sensor.", "(0, 0.001]", "m")
    nominal_delay: int = parameter(
        1, "Delay of the velocity in samples that is assumed until one is found.", f"[{EARLIEST}, {LATEST}]"
    )
    mu_c0: float = parameter(0.5, "Start value of mu_c: the middle of what pads show.", "(0, inf)")
    mu_s0: float = parameter(0.65, "Start value of mu_s.", "(0, inf)")
    r0: float = parameter(0.01, "Start value of r: that of a uniform disc as large as the pad.", RADIUS, "m")
    mu_min: float = parameter(0.01, "mu_s and mu_c are kept at or above this.", "(0, inf)")
    mu_max: float = parameter(10.0, "mu_s and mu_c are kept at or below this.", "(0, inf)")
    r_min: float = parameter(1e-4, "r is kept at or above this.", RADIUS, "m")
    r_max: float = parameter(0.015, "Radius of the pad: r is kept at or below this.", RADIUS, "m")
    eps_fn: float = parameter(0.2, "Normal force from which there is contact.", "(0, inf)", "N")
    eps_v: float = parameter(1.5e-3, "Scaled speed above which the contact moves.", "(0, inf)", "m/s")
    sd_log_mu_c0: float = parameter(1.2, "Standard deviation of ln mu_c at the start.", "(0, 3]")
    sd_log_r0: float = parameter(0.6, "Standard deviation of ln r at the start.", "(0, 3]")
    sd_log_ratio: float = parameter(0.15, "Standard deviation of ln (mu_s / mu_c) at the start.", "(0, 1]")
    viscosity0: float = parameter(0.2, "Expected viscous friction sigma_2.", "[0, inf)", "s/m")
    sd_viscosity: float = parameter(0.12, "Spread of the viscous friction.", "(0, inf)", "s/m")
    stribeck_velocity: float = parameter(
        1e-3, "Speed v_s below which a slip has a part of static friction.", "(0, inf)", "m/s"
    )
    sd_zero: float = parameter(0.1, "Spread of the zero error of each force.", "(0, inf)", "N")
    sd_zero_torque: float = parameter(6e-4, "Spread of the zero error of the torque.", "(0, inf)", "N m")
    sd_tilt: float = parameter(
        0.015, "Spread of the tilt of the force sensor about each axis.", "(0, inf)", "rad"
    )
    sd_cop: float = parameter(
        0.7, "Spread of the error of the centre of pressure, each way.", "(0, 200]", "mm"
    )
    sd_gain: float = parameter(
        0.02, "Relative errors that no motion shows: gain, cross-talk, anisotropy.", "[0, inf)"
    )
    law_error: float = parameter(
        0.035, "Relative error of the friction law in a stretch of slip, at first.", "(0, inf)"
    )
    compliance: float = parameter(
        4e-5,
        "Shear compliance up to which a pad counts as hard: no dependence on the load.",
        "(0, inf)",
        "m/N",
    )
    compliance_max: float = parameter(2.5e-4, "Largest shear compliance of a pad.", "(0, inf)", "m/N")
    unmeasured: int = parameter(
        0, "What the sensors lack: 0 nothing, 1 the slip velocity, 2 the tangential force, too.", "[0, 2]"
    )
    memory: float = parameter(1.5, "Time of slip after which a stretch counts 1 / e.", "(0, inf)", "s")

    def __post_init__(self) -> None:
        super().__post_init__()
        self._ordered("mu_min", "mu_c0", "mu_max")
        self._ordered("mu_min", "mu_s0", "mu_max")
        self._ordered("r_min", "r0", "r_max")
