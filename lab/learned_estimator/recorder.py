"""An estimator that keeps what it is given: the readings of a finger since the start of its episode."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from estimator._numba.entry_point import entry_point
from estimator.estimate import COMMON_STATE
from estimator.parameters import RADIUS, Parameters, parameter
from estimator.registry import Specification

ROOM = 1024
"""Most readings that are kept."""
NAME = "lab.learned_estimator.recorder:SPECIFICATION"
"""Its name for `estimator.make` and the environments."""


@dataclass(frozen=True)
class RecorderParameters(Parameters):
    """The friction that it states all the time, without confidence."""

    mu_s0: float = parameter(0.9, "Stated mu_s.", "(0, inf)")
    mu_c0: float = parameter(0.7, "Stated mu_c.", "(0, inf)")
    r0: float = parameter(0.01, "Stated r.", RADIUS, "m")


STATE = np.dtype([*COMMON_STATE, ("readings", np.float32, (ROOM, 7))], align=True)
"""`readings`: wrench and twist, (f_x, f_y, f_n, tau, v_x, v_y, omega) [N, N, N, N m, m/s, m/s, rad/s]."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States before the first sample, (m,) from parameters (m,)."""
    states = np.zeros(len(parameters), STATE)
    for name in ("mu_s", "mu_c", "r"):
        states[name] = parameters[f"{name}0"]
    return states


@entry_point(STATE, RecorderParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Keeps a sample of each of n fingers; those beyond `ROOM` are counted only."""
    for i in range(len(states)):
        state, estimate = states[i], estimates[i]
        if state.samples < ROOM:
            row = state.readings[state.samples]
            for k in range(4):
                row[k] = wrenches[i, k]
            for k in range(3):
                row[4 + k] = twists[i, k]
        state.samples += 1
        state.t = t
        estimate.mu_s, estimate.mu_c, estimate.r = state.mu_s, state.mu_c, state.r
        estimate.sd_mu_s, estimate.sd_mu_c, estimate.sd_r = state.mu_s, state.mu_c, state.r


SPECIFICATION = Specification(NAME, RecorderParameters, initial_states, update_batch)
