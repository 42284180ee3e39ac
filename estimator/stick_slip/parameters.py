"""Parameters that the shared functions need."""

from dataclasses import dataclass

from estimator.parameters import Parameters, parameter
from estimator.stick_slip.state import BUFFER_CAPACITY


@dataclass(frozen=True)
class StickSlipParameters(Parameters):
    """Defaults: Table 1 of Waltersson & Karayiannidis (ISER 2025), careful readings where it leaves room.

    A subclass adds `heuristic`, `r0` and `r_max`, whose defaults are its own.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    mu_c0: float = parameter(1.3, "Start value of mu_c.", "(0, inf)")
    mu_s0: float = parameter(1.5, "Start value of mu_s.", "(0, inf)")
    mu_min: float = parameter(0.01, "mu_s and mu_c are kept at or above this.", "(0, inf)")
    mu_max: float = parameter(10.0, "mu_s and mu_c are kept at or below this.", "(0, inf)")
    r_min: float = parameter(1e-4, "r is kept at or above this.", "(0, inf)", "m")
    eps_fn: float = parameter(0.2, "Normal force from which there is contact.", "(0, inf)", "N")
    eps_v: float = parameter(
        1.5e-3, "Scaled speed above which the motion regime holds and a slip starts.", "(0, inf)", "m/s"
    )
    eps_t: float = parameter(0.3, "Gate: gamma_t above which mu_c and mu_s learn.", "(0, 1)")
    forgetting: float = parameter(
        0.98, "Forgetting factor lambda; its memory is 1 / (1 - lambda) updates.", "(0, 1)"
    )
    n_a: int = parameter(
        2, "How many of the largest buffered ratios are averaged to mu_s.", f"[1, {BUFFER_CAPACITY}]"
    )
    n_b: int = parameter(16, "Length of the buffer of ratios.", f"[1, {BUFFER_CAPACITY}]")
    stick_band: float = parameter(
        1e-4, "Speed up to which a sample counts as zero velocity; 0 is the literal text.", "[0, inf)", "m/s"
    )
    stick_samples: int = parameter(
        3, "Zero samples in a row that make a stop; 1 is the literal text.", "[1, 1000]"
    )
    eps_delta: float = parameter(
        150.0, "Rate of rise of f_n above which the heuristic halts.", "(0, inf)", "N/s"
    )
    halt_duration: float = parameter(
        0.05, "Duration Delta t of a halt, triggering sample included.", "(0, inf)", "s"
    )
    sample_time: float = parameter(
        1 / 120,
        "Nominal sampling interval delta t; half of it is the tolerance of a halt's end.",
        "(0, inf)",
        "s",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        self._ordered("n_a", "n_b")
        self._ordered("stick_band", "eps_v")
        self._ordered("sample_time", "halt_duration")
        self._ordered("mu_min", "mu_c0", "mu_max")
        self._ordered("mu_min", "mu_s0", "mu_max")
        self._ordered("r_min", "r0", "r_max")

    def _ordered(self, *names: str) -> None:
        values = [getattr(self, name) for name in names]
        if values != sorted(values):
            given = ", ".join(f"{name} = {value!r}" for name, value in zip(names, values, strict=True))
            raise ValueError(f"{given}: expected {' <= '.join(names)}")
