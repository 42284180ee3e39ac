"""State of the "adaptive" estimator, and its start."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from estimator._numba.caching import njit
from estimator.augmented.likelihood_ratio import forget_change
from estimator.augmented.load import MOST_FALL, MOST_GROWTH
from estimator.augmented.model_error import forget_slips
from estimator.augmented.slip_law import COP, FALLS, GROWS, MU, SHAPE, SIGMA, STATES, TILT, ZERO, R
from estimator.augmented.timing import CANDIDATES, NEWEST, RING
from estimator.augmented.torsion import TURN
from estimator.stick_slip import EVENT_STATE, STICK_SLIP_STATE, start

_IN_CONTACT: list[tuple[Any, ...]] = [
    ("elapsed", np.float64),
    ("in_a_row", np.int64),
    ("moved", np.int64),
    ("beyond", np.int64),
    ("first", np.int64),
    ("quiet", np.int64),
    ("delay", np.int64),
    ("sign", np.float64),
    ("unloaded", np.bool_),
    ("touched", np.bool_),
    ("signed", np.bool_),
    ("zero_normal", np.float64),
    ("zero_torque", np.float64),
    ("timing", np.float64),
    ("offset", np.float64),
    ("sd_lever", np.float64),
    ("variance_mu_s", np.float64),
    ("common_mu_s", np.float64),
    ("above", np.int64),
    ("least", np.float64),
    ("load", np.float64),
    ("held", np.float64),
    ("held_load", np.float64),
    ("resting", np.int64),
    ("rest_sample", np.int64),
    ("restless", np.float64),
    ("rest", np.float64, (3,)),
    ("turn", np.float64, (TURN,)),
    ("torsion", np.float64),
    ("x", np.float64, (STATES,)),
    ("products", np.float64, (CANDIDATES,)),
    ("energies", np.float64, (2,)),
    ("forces", np.float32, (NEWEST, 3)),
]
"""Used at every sample."""

_IN_MOTION: list[tuple[Any, ...]] = [
    ("spring", np.float64),
    ("repeated", np.int64),
    ("moved_by", np.float64, (3,)),
    ("lowest", np.float64, (3,)),
    ("highest", np.float64, (3,)),
    ("before", np.float64, (3,)),
    ("slides", np.int64),
    ("slid", np.int64),
    ("misfit", np.float64),
    ("law_square", np.float64),
    ("at_bound", np.float64),
    ("leverage", np.float64),
    ("runs", np.float64, (2, 3)),
    ("scatter", np.float64),
    ("suspected", np.bool_),
    ("change_samples", np.int64),
    ("change_events", np.int64),
    ("change_fit", np.float64),
    ("changes", np.float64),
    ("change_information", np.float64),
    ("response", np.float64, (STATES,)),
    ("shared", np.float64),
    ("smooth", np.float64, (4,)),
    ("separate", np.float64),
    ("contrast", np.float64),
    ("difference", np.float64),
    ("innovation", np.float64),
    ("expected", np.float64),
    ("slip_samples", np.int64),
    ("fall_error", np.float64),
    ("limits", np.float64, (8,)),
    ("covariance", np.float64, (STATES, STATES)),
]
"""Used while the contact moves."""

STATE = np.dtype(
    [
        *STICK_SLIP_STATE,
        *_IN_CONTACT,
        ("wrenches", np.float32, (RING, 4)),
        ("twists", np.float32, (RING, 3)),
        *_IN_MOTION,
        ("fallen", np.int64),
        ("variance_normal", np.float64),
        ("variance_torque", np.float64),
        ("event", np.float64),
        ("event_load", np.float64),
        ("doubt", np.float64),
        ("certain", np.bool_),
        *EVENT_STATE,
    ],
    align=True,
)
"""`x`, `covariance`: the filter; `limits`: of ln mu_c, ln r and both exponents; `delay`: of the velocity
[samples]; `timing`: its correlation; `offset`: its fraction of a sample; `sign`: 1 if the wrench is that
on the finger, once `signed`; `unloaded`: whether the sensor was seen without load; `touched`: whether
there was contact; `zero_normal`, `zero_torque`: zero errors of f_n and tau [N, N m], with their
variances; `moved`: velocities in a row that moved; `repeated`: 1 if two were the same; `moved_by`: how
far [m, m, rad]; `lowest`, `highest`: f_x, f_y, tau meanwhile; `before`: the same before it; `spring`:
compliance of the pad [m/N]; `beyond`: samples in a row that the motion was longer than the pad can
spring; `slid`: number of the newest sample of sliding; `first`: number of the first sample of a short
slip, -1 for none; `quiet`: samples since it moved; `fallen`: number of the sample after its break-away;
`slides`: instants of sliding learned from since the delay is as it is; `misfit`: mean squared normalised
innovation; `runs`: of the jump test, for a rise and a fall: sum of the excess, number and sum of
innovations; `suspected`, `response`, `change_fit`, `change_information`, `change_samples`,
`change_events`: the hypothesis of a change of mu_c before a slip, and `changes`: sum of the squares of those
that were found, fading, see `estimator.augmented.likelihood_ratio`;
`law_square`: squared relative error of the law; `at_bound`: 1 while r is at one of its
bounds, fading afterwards; `scatter`: mean square of all innovations; `load`: normal force at which
ln mu_c and ln r are [N];
`held`, `held_load`: largest ratio that was carried, and its normal force [-, N]; `resting`: samples in a
row at rest; `rest`: f_x, f_y, f_n at one of them [N], of number `rest_sample`; `restless`: mean squared
change of the load at rest [N^2]; `turn`: regression of the torque on the angle, see
`estimator.augmented.torsion`; `torsion`: compliance that the pad has shown there [rad/(N m)],
0 for none; `event`, `event_load`: mu_s of the last events, and its normal force [-, N];
`doubt`: expected squared error of ln mu_s, as they may have been springs of the pad; `certain`: whether a
motion was longer than that."""


RESTLESS = 0.1
"""Change of a load at rest [N] that is expected at first."""
_SPREADS = {MU: "log_mu_c0", R: "log_r0", SIGMA: "viscosity", ZERO: "zero", ZERO + 1: "zero"}
_SPREADS |= {TILT: "tilt", TILT + 1: "tilt", COP: "cop", COP + 1: "cop", SHAPE: "shape"}
_SPREADS |= {FALLS: "load_exponent", GROWS: "radius_exponent"}
"""State -> parameter `sd_...` that is its spread."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States before the first sample.

    Args:
        parameters: Structured array (m,).

    Returns:
        Structured array (m,) of dtype STATE.
    """
    states = start(parameters, STATE)
    states["x"][:, MU], states["x"][:, R] = np.log(parameters["mu_c0"]), np.log(parameters["r0"])
    states["x"][:, SIGMA] = parameters["viscosity0"]
    for at, name in _SPREADS.items():
        assumed = parameters["caution"] if SIGMA < at <= SHAPE else 1.0
        states["covariance"][:, at, at] = (assumed * parameters[f"sd_{name}"]) ** 2
    states["x"][:, FALLS] = parameters["load_exponent0"]
    states["x"][:, GROWS] = parameters["radius_exponent0"]
    for at, name in enumerate(("mu_min", "mu_max", "r_min", "r_max")):
        states["limits"][:, at] = np.log(parameters[name])
    states["limits"][:, 4:] = 0.0, MOST_FALL, 0.0, MOST_GROWTH
    states["fall_error"] = parameters["sd_fall"] ** 2
    states["variance_normal"] = parameters["sd_zero"] ** 2
    states["variance_torque"] = parameters["sd_zero_torque"] ** 2
    states["delay"], states["spring"] = parameters["nominal_delay"], parameters["compliance_max"]
    states["fallen"] = states["first"] = states["slid"] = -1
    states["sign"] = states["misfit"] = 1.0
    states["law_square"] = parameters["law_error"] ** 2
    states["restless"] = RESTLESS * RESTLESS
    states["sd_lever"] = 2**0.5 * states["mu_c"] * states["r"]
    return states


@njit
def restart(state, p):
    """Forgets the errors of the sensors and how sure mu_c and r were; their values stay until a slip."""
    x, covariance = state.x, state.covariance
    for j in range(STATES):
        kept = state.unloaded and ZERO <= j < TILT  # the zero error as the unloaded sensor showed it
        variance = covariance[j, j]
        for k in range(STATES):
            covariance[j, k] = 0.0
        if j >= SIGMA and not kept:
            x[j] = _expected(p, j)
        spread = _spread(p, j)
        assumed = p.caution if SIGMA < j <= SHAPE else 1.0
        covariance[j, j] = variance if kept else (assumed * spread) ** 2
    state.misfit, state.slides = 1.0, 0
    state.law_square, state.at_bound = p.law_error * p.law_error, 0.0
    state.runs[:] = 0.0
    forget_change(state)
    state.spring, state.torsion = p.compliance_max, 0.0
    forget_slips(state)


@njit
def _expected(p, j):
    """Start value of a state after ln r."""
    if j == SIGMA:
        return p.viscosity0
    return p.load_exponent0 if j == FALLS else p.radius_exponent0 if j == GROWS else 0.0


@njit
def _spread(p, j):
    """Standard deviation of a state at the start."""
    if j < ZERO:
        return p.sd_log_mu_c0 if j == MU else p.sd_log_r0 if j == R else p.sd_viscosity
    if j < COP:
        return p.sd_zero if j < TILT else p.sd_tilt
    if j <= SHAPE:
        return p.sd_cop if j < SHAPE else p.sd_shape
    return p.sd_load_exponent if j == FALLS else p.sd_radius_exponent
