"""Stands in for the estimators of an environment with `estimator=None`: it learns nothing."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from estimator._numba.entry_point import entry_point
from estimator.estimate import COMMON_STATE
from estimator.parameters import Parameters, parameter
from estimator.registry import Specification

NAME = "slipgym.envs.no_estimator:SPECIFICATION"
"""Its name for `estimator.make_batch`."""


@dataclass(frozen=True)
class NoEstimatorParameters(Parameters):
    """Friction that it states all the time, without confidence."""

    mu_s0: float = parameter(0.9, "Stated mu_s.", "(0, inf)")
    mu_c0: float = parameter(0.7, "Stated mu_c.", "(0, inf)")
    r0: float = parameter(0.01, "Stated r.", "(0, inf)", "m")


STATE = np.dtype(COMMON_STATE, align=True)


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States before the first sample, (m,) from parameters (m,)."""
    states = np.zeros(len(parameters), STATE)
    for name in ("mu_s", "mu_c", "r"):
        states[name] = parameters[f"{name}0"]
    return states


@entry_point(STATE, NoEstimatorParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Changes nothing."""


SPECIFICATION = Specification(NAME, NoEstimatorParameters, initial_states, update_batch)
