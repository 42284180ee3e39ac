"""Shared parts of all estimators: parameters, state, mu_s from stick-slip events, the heuristic that halts.

Source: Waltersson & Karayiannidis, Friction Estimation for In-Hand Planar Motion (ISER 2025): Algorithm 1 for
mu_s, and the heuristic. In the compiled functions `state` is a record whose dtype holds STICK_SLIP_STATE and
EVENT_STATE, `p` a record of a subclass of StickSlipParameters.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from estimator._numba.caching import njit
from estimator.estimate import COMMON_STATE
from estimator.parameters import RADIUS, Parameters, parameter
from estimator.sample import clamped

BUFFER_CAPACITY = 64
"""Largest n_b: the buffer is part of the state, whose size is fixed."""


@dataclass(frozen=True)
class StickSlipParameters(Parameters):
    """Defaults: Table 1 of Waltersson & Karayiannidis (ISER 2025), our choice where the paper gives no value.

    A subclass adds `heuristic`, `r0` and `r_max`, whose defaults are its own.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    mu_c0: float = parameter(1.3, "Start value of mu_c.", "(0, inf)")
    mu_s0: float = parameter(1.5, "Start value of mu_s.", "(0, inf)")
    mu_min: float = parameter(0.01, "mu_s and mu_c are kept at or above this.", "(0, inf)")
    mu_max: float = parameter(10.0, "mu_s and mu_c are kept at or below this.", "(0, inf)")
    r_min: float = parameter(1e-4, "r is kept at or above this.", RADIUS, "m")
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
        1e-4, "Speed up to which a sample counts as zero velocity; 0 is as published.", "[0, inf)", "m/s"
    )
    stick_samples: int = parameter(
        3, "Zero samples in a row that make a stop; 1 is as published.", "[1, 1000]"
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


STICK_SLIP_STATE: list[tuple[Any, ...]] = [
    *COMMON_STATE,
    ("sd_mu_s", np.float64),
    ("sd_mu_c", np.float64),
    ("sd_r", np.float64),
    ("confidence_mu_s", np.float64),
    ("confidence_mu_c", np.float64),
    ("confidence_r", np.float64),
    ("events_mu_s", np.int64),
    ("updates_mu_c", np.int64),
    ("updates_r", np.int64),
    ("f_n", np.float64),
    ("halt_left", np.float64),
    ("still_samples", np.int64),
    ("slipping", np.bool_),
]
"""Used at every sample. `f_n`: normal force of the previous sample [N]; `halt_left`: remaining time of a
halt [s]."""

EVENT_STATE: list[tuple[Any, ...]] = [
    ("scatter_mu_s", np.float64),
    ("changes_mu_s", np.int64),
    ("gain_mu_s", np.float64),
    ("buffer_size", np.int64),
    ("buffer_next", np.int64),
    ("buffer", np.float64, (BUFFER_CAPACITY,)),
]
"""Used in stick and at its end; the last fields of a state, so that the others are close together in memory.
`scatter_mu_s`: variance of one event, from `changes_mu_s` changes; `gain_mu_s`: weight of the last event;
`buffer`: ring of force ratios [-]."""

SCATTER_GAIN = 0.2
"""Weight of a new event in the scatter of mu_s, once 1 / SCATTER_GAIN changes have been averaged."""


def start(parameters: NDArray[np.void], dtype: np.dtype[np.void]) -> NDArray[np.void]:
    """States (m,) with the start values of the shared fields, by parameters (m,); the others are zero.

    The standard deviation of mu_s, mu_c and r is initialised to the value itself.
    """
    states = np.zeros(len(parameters), dtype)
    for name in ("mu_s", "mu_c", "r"):
        states[name] = states[f"sd_{name}"] = parameters[f"{name}0"]
    return states


@njit
def halts(state, p, f_n, elapsed):
    """Heuristic: a rise of f_n faster than eps_delta halts for halt_duration; a new rise restarts the halt.

    The sample at which exactly halt_duration has passed learns again. Half a sample of tolerance makes this
    hold for times with rounding errors or jitter.
    """
    if not p.heuristic or state.samples == 0:
        return False
    state.halt_left = max(state.halt_left - elapsed, 0.0)
    if (f_n - state.f_n) / elapsed > p.eps_delta:
        state.halt_left = p.halt_duration - 0.5 * p.sample_time
    return state.halt_left > 0.0


@njit
def clear_buffer(state):
    """Empties the buffer of force ratios."""
    state.buffer_size = 0
    state.buffer_next = 0


@njit
def append(state, p, ratio):
    """Buffers a force ratio; it replaces the oldest of n_b."""
    state.buffer[state.buffer_next] = ratio
    state.buffer_next = state.buffer_next + 1 if state.buffer_next + 1 < p.n_b else 0
    state.buffer_size = min(state.buffer_size + 1, p.n_b)


@njit
def take_event(state, p):
    """Mean of the n_a largest buffered ratios, within bounds; each is overwritten by -1."""
    total = 0.0
    for _ in range(p.n_a):
        largest = 0
        for i in range(state.buffer_size):
            if state.buffer[i] > state.buffer[largest]:
                largest = i
        total += state.buffer[largest]
        state.buffer[largest] = -1.0  # below every ratio
    return clamped(total / p.n_a, p.mu_min, p.mu_max)


@njit
def transition(state, p, still, moves):
    """Advances the stick-slip state machine by a sample, `still` within stick_band or it `moves` above eps_v.

    Returns:
        Whether a slip starts, and whether one stops, at this sample.
    """
    state.still_samples = state.still_samples + 1 if still else 0
    starts = moves and not state.slipping
    stops = state.slipping and state.still_samples >= p.stick_samples
    if starts or stops:
        state.slipping = starts
    return starts, stops


@njit
def learn_mu_s(state, value, gain, jumps):
    """Moves mu_s towards the value of an event with weight `gain`.

    The standard deviation comes from the scatter of independent events: a change has the variance of one
    event plus that of the average before it. An event with `jumps` marks a change of mu_s itself and is left
    out of the scatter. Before the first change the standard deviation is mu_s itself.
    """
    if state.events_mu_s > 0 and not jumps:
        state.changes_mu_s += 1
        weight = max(1.0 / state.changes_mu_s, SCATTER_GAIN)
        square = (value - state.mu_s) ** 2 / (1.0 + state.gain_mu_s)
        state.scatter_mu_s = (1.0 - weight) * state.scatter_mu_s + weight * square
    state.mu_s = (1.0 - gain) * state.mu_s + gain * value
    state.gain_mu_s = gain
    state.events_mu_s += 1
    state.confidence_mu_s = state.events_mu_s / (state.events_mu_s + 1.0)
    state.sd_mu_s = math.sqrt(gain * state.scatter_mu_s) if state.changes_mu_s > 0 else state.mu_s


@njit
def lose_contact(state):
    """Ends a halt and a slip, and empties the buffer."""
    state.halt_left = 0.0
    state.slipping = False
    state.still_samples = 0
    clear_buffer(state)
