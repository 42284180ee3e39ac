"""Names the states of the fit, and declares the records: interval, stretch, entry, and finger."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from estimator.stick_slip import STICK_SLIP_STATE, start
from estimator.window.parameters import EARLIEST, LATEST

MU, RATIO, R, SHAPE, SIGMA, ZERO, TORQUE, TILT, COP = 0, 1, 2, 3, 4, 5, 7, 8, 10
FALLS, GROWS, OLD, STATES = 12, 13, 14, 15
"""States: ln mu_c, ln (mu_s / mu_c), ln r, shape of the limit surface, sigma_2 [s/m]; zero errors of f_x, f_y
[N] and tau [N m]; tilt about both axes [rad]; offset of the centre of pressure, each way [m]; exponents with
which mu_c falls and r grows with the normal force; how much ln mu_c was larger before the newest slips."""


def _numbers(names: str, kind: Any = np.float64) -> list[tuple[Any, ...]]:
    """Fields of the names, one number each."""
    return [(name, kind) for name in names.split()]


_MEAN = [("motion", np.float64, (3,)), ("wrench", np.float64, (4,)), *_numbers("time count slow")]
INTERVAL = np.dtype(_MEAN, align=True)
"""Displacement [m, m, rad]; wrench at its end [N, N, N, N m]; duration [s]; number of samples; in a slip
exp(-(v / v_s)^2) [-]."""
STRETCH = np.dtype([*_MEAN, *_numbers("work instants")], align=True)
"""The stretch of slip that grows: an `INTERVAL` whose wrench and `slow` are multiplied by the duration; work
of the load [J], number of instants."""
ENTRY = np.dtype([*_MEAN, ("kind", np.int64), *_numbers("end load slides var_speed noise")], align=True)
"""Entry of the window: an `INTERVAL` with a twist in place of a displacement; slip time at its end [s]; ln of
its normal force over the reference; probability that it is no spring of the pad; variance of the speed; that
of the wrench over a reading's."""
EMPTY, SLIDE, BREAK, FALL = 0, 1, 2, 3
"""Kinds: a stretch of slip, the load before a slip, the load after its fall."""
SAMPLES, INTERVALS, ENTRIES = 32, 16, 24
"""Lengths of the rings."""
SHORTEST = 0.007  # Duration of an interval [s]: a sample at 120 Hz, in which 1.5 mm/s are one count of 10 um
LATE = 3
"""Intervals by which a velocity is late at most, 21 ms; twice as many after which rest has shown, and three
times as many after rest, when the chip of a sensor that sleeps takes up to 40 ms to wake up."""
AT_LEAST = 0.5  # Smallest ratio of mu_c and mu_s
SIGMAS = 3.0  # Deviations by which a reading is off at most
EVENT = 0.08
"""Relative deviation of one break-away: the load is read between ramp and fall, the largest of noisy samples
counts, and friction depends on place and time in stick by some per cent. No smaller fall counts."""

STATE = np.dtype(
    [
        *STICK_SLIP_STATE,
        *_numbers("in_a_row delay interval run repeated quiet first entry fits", np.int64),
        *_numbers("touched learned", np.bool_),
        *_numbers("elapsed timing sign power stored unloaded variance_normal noise spring slip_time changed"),
        *_numbers("split reference misfit at_bound unmeasured fit_time springs sd_lever held"),
        ("products", np.float64, (LATEST - EARLIEST + 1,)),
        ("energies", np.float64, (2,)),
        ("zeros", np.float64, (4,)),
        ("peak", np.float64, (4,)),
        ("rest", np.float64, (4,)),
        ("wrenches", np.float64, (SAMPLES, 4)),
        ("twists", np.float64, (SAMPLES, 3)),
        ("growing", INTERVAL),
        ("intervals", INTERVAL, (INTERVALS,)),
        ("stretch", STRETCH),
        ("entries", ENTRY, (ENTRIES,)),
        ("x", np.float64, (STATES,)),
        ("mean", np.float64, (STATES,)),
        ("variance", np.float64, (STATES,)),
        ("covariance", np.float64, (STATES, STATES)),
    ],
    align=True,
)
"""`in_a_row`: samples in contact; `delay` of the velocity [samples], `timing`: its correlation, from
`products` and `energies`; `sign`: 1 if the wrench is that on the finger, by the sum `power`; `unloaded`:
samples without load, which gave the `zeros` of the wrench; `wrenches`, `twists`: rings of samples;
`growing`: the interval that grows; `interval`: number of the next one; `noise`: of the speed [m/s];
`spring`: largest compliance of the pad that is possible [m/N]; `run`: intervals in a row that moved,
`repeated`: 1 if two of them were the same, `first`: number of the first one, `quiet`: those at rest since
then, `learned`: whether the slip has an entry; `peak`: wrench of the largest load before it; `rest`: wrench
at the last look at a stick; `stored`: instants of the stretch that its entry has; `slip_time`: time of slip
so far [s]; `changed`: slip time of the newest change of friction, 0 for none; `split`: slip time before
which an entry is an old one; `entry`: number of the next one; `reference`: ln of the normal force at which
ln mu_c and ln r are, that of the first entry; `mean`, `variance`: of the states without any slip; `misfit`:
mean squared normalised residual; `at_bound`: 1 if r is at its bound; `unmeasured`: the parameter;
`fit_time`: time of the last fit [s]; `springs`: share of the entries that may be springs of the pad;
`held`: largest load over normal force that held, where no slip velocity is measured."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States (m,) before the first sample, for parameters (m,)."""
    states = start(parameters, STATE)
    mean, variance = states["mean"], states["variance"]
    mean[:, MU], mean[:, R] = np.log(parameters["mu_c0"]), np.log(parameters["r0"])
    mean[:, RATIO] = np.log(np.maximum(parameters["mu_s0"] / parameters["mu_c0"], 1.0))
    # pads of hardware are between a Hertzian pressure (0.9) and the ellipsoid of simulators (0)
    mean[:, SHAPE], mean[:, SIGMA] = 0.65, parameters["viscosity0"]
    states["x"] = mean
    names = (
        "sd_log_mu_c0 sd_log_ratio sd_log_r0 - sd_viscosity sd_zero sd_zero sd_zero_torque sd_tilt sd_tilt"
    )
    for at, name in enumerate(names.split()):
        if at != SHAPE:
            variance[:, at] = parameters[name] ** 2
    variance[:, SHAPE] = 0.6**2
    variance[:, COP:FALLS] = 1e-6 * parameters["sd_cop"][:, None] ** 2
    states["covariance"][:, range(STATES), range(STATES)] = variance
    states["variance_normal"] = parameters["sd_zero"] ** 2
    states["delay"], states["spring"] = parameters["nominal_delay"], parameters["compliance_max"]
    states["noise"], states["unmeasured"] = 2e-4, parameters["unmeasured"]
    states["sign"] = states["misfit"] = 1.0
    states["sd_lever"] = 2**0.5 * states["mu_c"] * states["r"]
    return states
