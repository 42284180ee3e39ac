"""The "gru" estimator: a recurrent network that was trained on simulated slips.

The network (`lab.learned_estimator.cell`) reads the samples of a finger one by one and states mu_s, mu_c and
r with standard deviations, which it learned by their likelihood. Its weights are a file of plain numbers,
which travel in the record of parameters, so that other weights need no other program.
"""

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from estimator._numba.caching import njit
from estimator._numba.entry_point import entry_point
from estimator.estimate import confidence_of
from estimator.parameters import RADIUS, parameter
from estimator.registry import Specification
from estimator.sample import clamped, publish, readable
from estimator.stick_slip import STICK_SLIP_STATE, StickSlipParameters, start
from lab.learned_estimator.cell import HIDDEN, LEVER, MU_C, MU_S, TARGETS, R, advance, working_arrays
from lab.learned_estimator.features import TAPS, sense
from lab.learned_estimator.weights import SHAPES, load

NAME = "lab.learned_estimator.gru:SPECIFICATION"
"""Its name for `estimator.make` and the environments."""

_confidence = njit(confidence_of, error_model="numpy")


@dataclass(frozen=True)
class GruParameters(StickSlipParameters):
    """Start values, the thresholds of contact, slip and stick, and the file of the weights.

    Raises:
        FileNotFoundError: There is no such file of weights.
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one,
            or the file of weights is damaged.
    """

    mu_c0: float = parameter(0.7, "Start value of mu_c: the middle of what pads show.", "(0, inf)")
    mu_s0: float = parameter(0.9, "Start value of mu_s.", "(0, inf)")
    heuristic: bool = parameter(True, "Whether the network sees that f_n rises fast.")
    r0: float = parameter(0.01, "Start value of r: that of a uniform disc as large as the pad.", RADIUS, "m")
    r_max: float = parameter(0.015, "r is kept at or below this: the pad's radius.", RADIUS, "m")
    weights: str = parameter("", "File of the network's weights (npz); empty: those that come with it.")

    def __post_init__(self) -> None:
        super().__post_init__()
        load(self.weights)

    @classmethod
    def dtype(cls) -> np.dtype[np.void]:
        """The fields but the file, and the tensors of the network."""
        fields = [(field.name, field.type) for field in dataclasses.fields(cls) if field.type is not str]
        tensors = [(name, np.float32, shape) for name, shape in SHAPES.items()]
        return np.dtype([*fields, *tensors], align=True)

    def as_array(self) -> NDArray[np.void]:
        """The values and the tensors as a structured array, shape (1,)."""
        values = np.zeros(1, self.dtype())
        for field in dataclasses.fields(self):
            if field.type is not str:
                values[field.name] = getattr(self, field.name)
        for name, tensor in load(self.weights).items():
            values[name] = tensor
        return values


STATE = np.dtype(
    [
        *STICK_SLIP_STATE,
        ("touched", np.bool_),
        ("unloaded", np.int64),
        ("in_contact", np.int64),
        ("age", np.int64),
        ("v_t", np.float64),
        ("sd_lever", np.float64),
        ("zero", np.float64, (4,)),
        ("taps", np.float64, (TAPS, 2)),
        ("logs", np.float64, (TAPS, 2)),
        ("mean", np.float32, (TARGETS,)),
        ("hidden", np.float32, (HIDDEN,)),
    ],
    align=True,
)
"""`unloaded`: readings before the first contact, whose mean is `zero`; `touched`: there was contact;
`in_contact`, `age`: samples in contact, and since the last start or stop of a slip; `v_t`: speed of the last
sample [m/s]; `sd_lever`: of mu_c r [m]; `taps`, `logs`: last f_t / f_n and |tau| / (LENGTH f_n), and their
logarithms; `mean`: averages of ln mu_s, ln mu_c, ln r; `hidden`: of the network."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States before the first sample.

    Args:
        parameters: Structured array (m,).

    Returns:
        Structured array (m,) of dtype STATE.
    """
    states = start(parameters, STATE)
    states["mean"] = parameters["start"]
    return states


@njit(error_model="numpy")
def _learn(state, p, out, saw_mu_c, saw_r):
    """Takes over what the network states; a value is its start value until a slip shows it.

    Returns:
        Standard deviation of mu_c r [m].
    """
    mean = state.mean
    if saw_mu_c:
        state.updates_mu_c += 1
    if saw_r:
        state.updates_r += 1
    if state.events_mu_s > 0:
        sd = math.exp(out[2 * TARGETS + MU_S])
        state.mu_s = clamped(math.exp(mean[MU_S]), p.mu_min, p.mu_max)
        state.sd_mu_s, state.confidence_mu_s = state.mu_s * sd, _confidence(sd * sd)
    if state.updates_mu_c > 0:
        sd = math.exp(out[2 * TARGETS + MU_C])
        state.mu_c = clamped(math.exp(mean[MU_C]), p.mu_min, p.mu_max)
        state.sd_mu_c, state.confidence_mu_c = state.mu_c * sd, _confidence(sd * sd)
    if state.updates_r > 0:
        sd = math.exp(out[2 * TARGETS + R])
        state.r = clamped(math.exp(mean[R]), p.r_min, p.r_max)
        state.sd_r, state.confidence_r = state.r * sd, _confidence(sd * sd)
    state.sd_lever = state.mu_c * state.r * math.exp(out[2 * TARGETS + LEVER])


@njit(error_model="numpy")
def _update(state, scratch, p, t, wrench, twist, estimate):
    """One finger, one sample."""
    size = abs(wrench[0]) + abs(wrench[1])
    if not readable(state, t, size, wrench[2], wrench[3], abs(twist[0]) + abs(twist[1]) + abs(twist[2])):
        return
    elapsed = t - state.t if state.samples > 0 else p.sample_time
    touches, halted, f_n, gamma_t, gamma_tau = sense(state, p, wrench, twist, elapsed, scratch[0])
    saw_mu_c = touches and state.slipping and gamma_t > p.eps_t
    saw_r = touches and state.slipping and gamma_tau > p.eps_t
    if touches:
        advance(p, scratch, state.hidden, state.mean)
        _learn(state, p, scratch[-1], saw_mu_c, saw_r)
    publish(state, t, f_n, gamma_t, gamma_tau, halted, saw_mu_c, saw_r, estimate)
    if state.sd_lever > 0.0:
        estimate.sd_lever = state.sd_lever


@entry_point(STATE, GruParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Updates n fingers by one sample each; see `estimator.registry.Specification`."""
    scratch = working_arrays()
    for i in range(len(states)):
        p = parameters[min(i, len(parameters) - 1)]
        wrench = wrenches[i, 0], wrenches[i, 1], wrenches[i, 2], wrenches[i, 3]
        twist = twists[i, 0], twists[i, 1], twists[i, 2]
        _update(states[i], scratch, p, t, wrench, twist, estimates[i])


SPECIFICATION = Specification(NAME, GruParameters, initial_states, update_batch)
