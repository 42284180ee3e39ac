"""Parameters of the "rls" estimator."""

from dataclasses import dataclass

from estimator.parameters import parameter
from estimator.stick_slip.parameters import StickSlipParameters


@dataclass(frozen=True)
class RlsParameters(StickSlipParameters):
    """Defaults: Table 1 of Waltersson & Karayiannidis (ISER 2025), careful readings where it leaves room.

    Each field's metadata holds its documentation, unit and valid interval.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    heuristic: bool = parameter(
        True, "Whether a fast rise of f_n halts all updates; False is the plain estimator."
    )
    r0: float = parameter(0.02, "Start value of r.", "(0, inf)", "m")
    r_max: float = parameter(
        0.1, "r is kept at or below this, for example the pad's radius.", "(0, inf)", "m"
    )
    eps_tau: float = parameter(0.3, "Gate: gamma_tau above which r learns.", "(0, 1)")
    p0: float = parameter(1.0, "Start value P0 of both RLS covariances.", "(0, inf)", "1/N^2")
    covariance_limit: float = parameter(
        1.0,
        "Upper bound of the covariances as a multiple of p0, against wind-up; inf is the literal text.",
        "[1, inf]",
    )
    low_speed_gamma_from_force: bool = parameter(
        True,
        "Whether gamma_t comes from the force up to eps_v; False, the literal text: only up to stick_band.",
    )
    machine_gated: bool = parameter(
        False,
        "True, the literal text: gamma_t <= eps_t stops the stick-slip machine, which watches v_t, not v.",
    )
