"""Parameters of the "adaptive" estimator."""

from dataclasses import dataclass

from estimator.augmented.timing import EARLIEST, LATEST
from estimator.parameters import parameter
from estimator.sliding import NoiseParameters


@dataclass(frozen=True)
class AdaptiveParameters(NoiseParameters):
    """Those of sensors and pad, and its own: spreads are what a data sheet or a careful user would say.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    mu_c0: float = parameter(0.7, "Start value of mu_c: the middle of what pads show.", "(0, inf)")
    mu_s0: float = parameter(0.9, "Start value of mu_s.", "(0, inf)")
    nominal_delay: int = parameter(
        1, "Delay of the velocity in samples that is assumed until one is found.", f"[{EARLIEST}, {LATEST}]"
    )
    sd_log_mu_c0: float = parameter(0.7, "Standard deviation of ln mu_c at the start.", "(0, 3]")
    sd_log_r0: float = parameter(0.7, "Standard deviation of ln r at the start.", "(0, 3]")
    viscosity0: float = parameter(0.2, "Expected viscous friction sigma_2.", "[0, inf)", "s/m")
    sd_viscosity: float = parameter(
        0.1, "Spread of the viscous friction before it is seen.", "(0, inf)", "s/m"
    )
    stribeck_velocity: float = parameter(
        1e-3, "Speed v_s below which a slip has a part of static friction.", "(0, inf)", "m/s"
    )
    sd_log_stribeck: float = parameter(0.5, "Standard deviation of ln v_s.", "[0, inf)")
    sd_log_ratio: float = parameter(
        0.2, "Standard deviation of ln (mu_s / mu_c) about that of the start values.", "(0, inf)"
    )
    sd_zero: float = parameter(0.13, "Spread of the zero error of each force.", "(0, inf)", "N")
    sd_zero_torque: float = parameter(1e-3, "Spread of the zero error of the torque.", "(0, inf)", "N m")
    walk_force: float = parameter(
        0.01, "Random walk of the zero error of each force in a second.", "[0, inf)", "N/sqrt(s)"
    )
    walk_torque: float = parameter(
        1e-4, "Random walk of the zero error of the torque in a second.", "[0, inf)", "N m/sqrt(s)"
    )
    eps_open: float = parameter(
        0.6,
        "Normal force up to which a sensor may be unloaded before the first contact.",
        "[0, inf)",
        "N",
    )
    sd_tilt: float = parameter(
        0.03, "Spread of the tilt of the force sensor about each axis.", "(0, inf)", "rad"
    )
    sd_cop: float = parameter(
        1.1, "Spread of the error of the centre of pressure, each way.", "(0, inf)", "mm"
    )
    sd_shape: float = parameter(
        0.1, "Spread of the limit surface's shape: 0 is a uniform disc's, 1 the ellipsoid.", "(0, inf)"
    )
    load_exponent0: float = parameter(
        0.0, "Exponent of the normal force with which mu_c and mu_s are expected to fall.", "[0, 0.5]"
    )
    sd_load_exponent: float = parameter(0.15, "Spread of this exponent before it is seen.", "(0, 1]")
    hard: float = parameter(
        0.5, "Probability of a hard pad: its friction and radius do not depend on the load.", "[0, 1)"
    )
    radius_exponent0: float = parameter(
        0.0, "Exponent of the normal force with which r is expected to grow.", "[0, 0.34]"
    )
    sd_radius_exponent: float = parameter(0.1, "Spread of this exponent before it is seen.", "(0, 1]")
    sd_gain: float = parameter(
        0.02, "Relative errors that no motion shows: gain and cross-talk of the forces.", "[0, inf)"
    )
    sd_surface: float = parameter(
        0.05, "Relative scatter of mu_c and mu_s that all slips share: anisotropy.", "[0, inf)"
    )
    sd_slip: float = parameter(
        0.2, "Relative error of mu_c, mu_s and r that one slip has, before slips have shown it.", "(0, inf)"
    )
    sd_fall: float = parameter(
        0.05, "Error of what slips say of the exponents of the load, however many there are.", "[0, inf)"
    )
    compliance: float = parameter(
        5e-5,
        "Smallest shear compliance of the pad that is assumed, however stiff it seems.",
        "[0, inf)",
        "m/N",
    )
    compliance_max: float = parameter(2.5e-4, "Largest shear compliance of a pad.", "[0, inf)", "m/N")
    soft_torsion: bool = parameter(
        False,
        "Whether pads may spring in torsion as much as the smallest plausible r allows: soft fingertips.",
    )
    torsion_from_turns: bool = parameter(
        True, "Whether a turn to which the torque is proportional shows how far the pad springs in torsion."
    )
    grip_noise: bool = parameter(
        True, "Whether the twist of a slip on which the grip closes is uncertain by its whole change."
    )
    short_slips: bool = parameter(
        True, "Whether mu_c is learned from slips of fewer than four samples, by the force alone."
    )
    mu_s_from_sticks: bool = parameter(True, "Whether a stick that carries more than mu_s f_n raises mu_s.")
    mu_s_follows: bool = parameter(True, "Whether mu_s follows the changes of mu_c.")
    exponent_from_sticks: bool = parameter(
        True, "Whether what a stick holds at a larger normal force bounds the exponent of the load."
    )
    tilt_from_sticks: bool = parameter(
        True, "Whether the tilt is learned from a stick in which the normal force changes."
    )
    caution: float = parameter(
        0.1,
        "Fraction of these spreads that the filter assumes, so that an error must be evident.",
        "(0, 1]",
    )
    drift: float = parameter(
        2e-3, "Relative random walk of mu_c and of r per sample of sliding, standard deviation.", "(0, 1)"
    )
    drift_at_rest: float = parameter(5e-4, "The same of mu_c per sample in contact.", "[0, 1)")
    error_drift: float = parameter(
        0.003,
        "Random walk of each error of the sensors per sample of sliding, as a fraction of the error.",
        "[0, 1)",
    )
    drift_mu_s: float = parameter(0.01, "Relative random walk of mu_s per event.", "[0, 1)")
    law_error: float = parameter(
        0.035, "Relative error of the friction law in a sample that is expected at first.", "[0, inf)"
    )
    law_error_min: float = parameter(0.01, "Smallest one that is found.", "[0, inf)")
    law_gain: float = parameter(
        0.1, "Weight of a sample of sliding in the error of the law; 0 leaves it as it is.", "[0, 1]"
    )
    turn_error: float = parameter(
        2.0, "Error of a load's direction on the limit surface, over that of its size.", "[0, inf)"
    )
    outlier: float = parameter(16.0, "Squared normalised innovation from which noise is added.", "(3, inf)")
    jump_slack: float = parameter(0.75, "Jump test: deviations that an innovation may have.", "(0, inf)")
    jump_limit: float = parameter(
        6.0, "Jump test: sum of the excess that marks a change of mu_c.", "(0, inf)"
    )
    jump_evidence: float = parameter(
        12.0, "Jump test: square of the mean over that which scatter explains.", "[0, inf)"
    )
    jump_forgets_exponent: bool = parameter(
        True, "Whether a change of mu_c makes it forget how mu_c depends on the load."
    )
    jump_odds: float = parameter(
        5.0,
        "Likelihood-ratio test: logarithm of the ratio that marks a change of mu_c between two slips.",
        "(0, inf)",
    )
    sd_between_slips: float = parameter(
        0.05, "Relative difference of mu_c between slips that is no change of it.", "(0, inf)"
    )
    sd_jump: float = parameter(0.3, "Standard deviation of a jump of ln mu_c.", "(0, 3]")
    timing_memory: float = parameter(0.999, "Fading of the correlations per sample.", "(0, 1)")
    timing_gate: float = parameter(0.15, "Correlation from which the delay is believed.", "(0, 1)")
