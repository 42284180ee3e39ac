"""The coupled step of several pads against an independent minimisation of its convex potential."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from slipgym.contact.coupled import (
    assemble,
    norm,
    set_friction_level,
    solve_motion,
    solve_symmetric,
    step_pads,
)
from slipgym.contact.records import pads
from slipgym.contact.soft_pad import load_pad

H = 5e-4
NO_CELLS = None
UNIT = 1e-6  # [m]; the minimiser works in micrometres
EQUAL = {
    "mu_c": 0.4,
    "mu_s": 0.5,
    "stribeck_velocity": 1e-3,
    "sigma_0": 1e6,
    "sigma_1": 80.0,
    "sigma_2": 0.2,
    "r": 0.01,
}


@st.composite
def problems(draw):
    """Two pads, an object and its motion without friction."""
    array = pads(2, stribeck_velocity=1e-3, sigma_2=0.2)
    for pad in array:
        pad["mu_c"] = draw(st.floats(0.05, 1.0))
        pad["mu_s"] = pad["mu_c"] * draw(st.floats(1.0, 2.0))
        pad["sigma_0"] = 10.0 ** draw(st.floats(5.0, 6.0))
        pad["sigma_1"] = draw(st.floats(0.0, 200.0))
        pad["r"] = draw(st.floats(0.003, 0.015))
        pad["cop"] = draw(st.tuples(*[st.floats(-0.005, 0.005)] * 2))
        pad["normal"] = draw(st.floats(0.1, 30.0))
        direction = np.array(draw(st.tuples(*[st.floats(-1.0, 1.0)] * 3)))
        length = max(np.linalg.norm(direction), 1e-3)
        pad["z"] = direction / length * draw(st.floats(0.0, 1.0)) * pad["mu_c"] / pad["sigma_0"]
        load_pad(pad, pad["normal"])
    inertia = draw(st.floats(0.05, 0.5)), draw(st.floats(2e-5, 2e-3))
    centre = draw(st.tuples(*[st.floats(-0.03, 0.03)] * 2))
    scale = 10.0 ** draw(st.floats(-9.0, -4.0))
    x, y, t = draw(st.tuples(*[st.floats(-1.0, 1.0)] * 3))
    return array, inertia, centre, (scale * x, scale * y, scale * t / 0.01)


def potential(q, array, limits, inertia, centre, free):
    """Potential whose gradient is the momentum balance; written from the equations alone."""
    mass = np.array([inertia[0], inertia[0], inertia[1]])
    value = 0.5 / H**2 * np.sum(mass * (q - free) ** 2)
    for pad, limit in zip(array, limits, strict=True):
        arm = pad["cop"] - centre
        delta = np.array([q[0] - q[2] * arm[1], q[1] + q[2] * arm[0], pad["r"] * q[2]])
        n, reach = pad["normal"], limit / pad["sigma_0"]
        stiffness = pad["sigma_0"] + pad["sigma_1"] / H
        length = np.linalg.norm(pad["z"] + delta)
        spring = 0.5 * length**2 if length <= reach else reach * (length - 0.5 * reach)
        value += n * (stiffness * spring - pad["sigma_1"] / H * pad["z"] @ delta)
        value += n * 0.5 * pad["sigma_2"] / H * delta @ delta
    return value


def solve(array, inertia, centre, free, guess):
    return np.array(solve_motion(array, NO_CELLS, array["mu_s"], inertia, centre, free, guess, H))


@settings(deadline=None, max_examples=150)
@given(problems(), st.tuples(*[st.floats(-1.0, 1.0)] * 3))
def test_the_balance_is_met_from_any_guess(problem, guess):
    array, inertia, centre, free = problem
    limits = np.ascontiguousarray(array["mu_s"])
    limit = float(np.sum(limits * array["normal"]))
    found = []
    for start in (free, (0.0, 0.0, 0.0), tuple(1e-5 * g for g in guess)):
        motion = solve_motion(array, NO_CELLS, limits, inertia, centre, free, start, H)
        residual, _ = assemble(array, NO_CELLS, limits, inertia, centre, free, motion, H)
        assert norm(residual, array["r"][0]) <= 1e-9 * limit  # the solver stops at 1e-10
        found.append(motion)
    # Strong convexity: each motion is within residual / smallest curvature (mass / h^2) of the only one,
    # in a metric of mass and inertia; 1e-9 of the limit on the lightest object is 2 * 1e-9 F h^2 / m
    apart = np.abs(np.array(found) - found[0]).max(axis=0)
    reach = 2e-9 * limit * H**2
    weight = math.sqrt(inertia[0] * min(inertia[0], inertia[1] / 0.015**2))
    assert np.hypot(apart[0], apart[1]) <= reach / weight
    assert apart[2] <= reach / math.sqrt(inertia[1] * min(inertia[0], inertia[1] / 0.015**2))


@settings(deadline=None, max_examples=60)
@given(problems())
def test_no_other_motion_has_less_potential(problem):
    array, inertia, centre, free = problem
    limits = np.ascontiguousarray(array["mu_s"])
    data = array, limits, inertia, np.array(centre), np.array(free)
    motion = np.array(solve_motion(array, NO_CELLS, limits, inertia, centre, free, free, H))
    scale = np.array([UNIT, UNIT, UNIT / 0.01])
    unit = float(np.sum(limits * array["normal"])) * UNIT  # energy of a slip of one unit
    least = potential(motion, *data)
    start = motion + scale * (3.0, -2.0, 1.0)
    found = minimize(
        lambda q: (potential(q * scale, *data) - least) / unit,
        start / scale,
        method="Nelder-Mead",
        options={"xatol": 1e-5, "fatol": 1e-12, "maxiter": 4000, "maxfev": 4000},
    )
    # the minimiser, knowing nothing of gradients, finds no lower value; rounding of the potential of up to
    # 1e3 units leaves 1e-12
    assert found.fun >= -1e-9
    # and arrives at the same motion: curvature at least mass / h^2 turns its excess into a distance
    away = (found.x * scale - motion) / H
    kinetic = 0.5 * (inertia[0] * (away[0] ** 2 + away[1] ** 2) + inertia[1] * away[2] ** 2)
    assert kinetic <= max(found.fun, 0.0) * unit + 1e-9 * unit


@settings(deadline=None, max_examples=100)
@given(problems())
def test_the_derivative_is_that_of_the_residual(problem):
    array, inertia, centre, free = problem
    limits = np.ascontiguousarray(array["mu_s"])
    at = np.array(free)
    _, j = assemble(array, NO_CELLS, limits, inertia, centre, free, tuple(at), H)
    jacobian = np.array([[j[0], j[3], j[4]], [j[3], j[1], j[5]], [j[4], j[5], j[2]]])
    assert np.all(np.linalg.eigvalsh(jacobian) > 0.0)
    step = np.array([1e-12, 1e-12, 1e-10])
    for a in range(3):
        shift = step * (np.arange(3) == a)
        ahead, _ = assemble(array, NO_CELLS, limits, inertia, centre, free, tuple(at + shift), H)
        behind, _ = assemble(array, NO_CELLS, limits, inertia, centre, free, tuple(at - shift), H)
        slope = (np.array(ahead) - np.array(behind)) / (2.0 * step[a])
        # rounding: 1e-16 of forces of 100 N over 1e-12 m; curvature: 1e-12 of bristles of 1e-6 m
        size = np.sqrt(np.diag(jacobian) * jacobian[a, a])
        assert np.all(np.abs(slope - jacobian[:, a]) <= 1e-3 * size + 1e-13 / step[a])


@settings(deadline=None)
@given(st.lists(st.floats(-2.0, 2.0), min_size=9, max_size=9), st.tuples(*[st.floats(-5.0, 5.0)] * 3))
def test_symmetric_solver_against_numpy(entries, b):
    root = np.array(entries).reshape(3, 3)
    a = root @ root.T + 0.1 * np.eye(3)
    packed = (a[0, 0], a[1, 1], a[2, 2], a[0, 1], a[0, 2], a[1, 2])
    np.testing.assert_allclose(solve_symmetric(packed, b), np.linalg.solve(a, b), rtol=1e-8, atol=1e-8)


def test_a_pad_without_normal_force_takes_no_part():
    array = pads(2, **EQUAL)
    array["normal"] = 4.0, 0.0
    array["z"] = 1e-7
    alone = array[:1].copy()
    state = (0.2, 5e-4), (0.01, 0.0), (1e-5, 2e-5, 1e-4), (0.0, 0.0, 0.0), H
    assert step_pads(array, NO_CELLS, *state) == step_pads(alone, NO_CELLS, *state)
    assert array[0] == alone[0]
    np.testing.assert_array_equal(array["wrench"][1], 0.0)
    np.testing.assert_array_equal(array["z"][1], 0.0)


def test_without_any_normal_force_the_object_is_free():
    array = pads(2, **EQUAL)
    free = (1e-4, -2e-4, 3e-3)
    assert step_pads(array, NO_CELLS, (0.2, 5e-4), (0.01, 0.0), free, (0.0, 0.0, 0.0), H) == free


@pytest.mark.parametrize("h", [2.5e-4, 5e-4, 5e-3])
def test_momentum_is_balanced_however_far_the_guess(h):
    """Loads of up to three times the limit; in 5 ms an object drifts far beyond what the bristles reach."""
    rng = np.random.default_rng(0)
    for _ in range(400):
        array = pads(
            2, stribeck_velocity=1e-3, sigma_2=0.2, sigma_1=80.0, sigma_0=10 ** rng.uniform(5.3, 6.7)
        )
        array["mu_c"] = rng.uniform(0.2, 0.8)
        array["mu_s"] = array["mu_c"] * rng.uniform(1.0, 1.9)
        array["r"] = rng.uniform(0.004, 0.01)
        normal = rng.uniform(1.0, 25.0)
        for one in array:
            load_pad(one, normal)
        pad = array[0]
        held = 2.0 * pad["mu_s"] * pad["normal"]
        z, load = (v / np.linalg.norm(v) for v in rng.normal(size=(2, 3)))
        array["z"] = z * rng.uniform(0.0, 0.7) * pad["mu_s"] / pad["sigma_0"]
        mass, arm = rng.uniform(0.05, 0.4), np.array([1.0, 1.0, pad["r"]])
        inertia = mass, 1e-3 * mass
        free = tuple(h**2 * rng.uniform(0.0, 3.0) * held * load * arm / [mass, mass, inertia[1]])
        limits = tuple(set_friction_level(one, NO_CELLS, 0, h) for one in array)
        motion = solve_motion(array, NO_CELLS, limits, inertia, (0.0, 0.0), free, free, h)
        residual, _ = assemble(array, NO_CELLS, limits, inertia, (0.0, 0.0), free, motion, h)
        assert norm(residual, pad["r"]) <= 1e-9 * held
