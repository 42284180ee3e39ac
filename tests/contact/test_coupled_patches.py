"""The coupled step of patches against an independent potential, the rim and the ellipsoid."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from slipgym.contact.coupled import assemble, norm, set_friction_level, solve_motion, step_pads
from slipgym.contact.pressure import patch_cells
from slipgym.contact.records import ELASTIC_LIMIT, LOAD, SPEED_CAP, Z_X, Z_Y, X, Y, pads, patch
from slipgym.contact.soft_pad import load_pad

H = 2.5e-4
LAW = {"mu_c": 0.4, "mu_s": 0.5, "stribeck_velocity": 1e-3, "sigma_0": 1e6, "sigma_1": 80.0, "sigma_2": 0.2}


def patches(pressure: str, cells: int) -> np.ndarray:
    """Cells of two pads, in units of their r."""
    positions, shares = patch_cells(pressure, cells)
    return np.array([patch(positions / (shares @ np.hypot(*positions.T)), shares)] * 2)


@st.composite
def problems(draw):
    """Two pads in any state, levels fixed; an object and its motion without friction."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    array = pads(2, stribeck_velocity=1e-3, sigma_2=0.2)
    cells = patches(draw(st.sampled_from(["uniform", "hertz", "rim"])), draw(st.sampled_from([3, 5, 8])))
    size = cells.shape[2]
    for pad, own in zip(array, cells, strict=True):
        pad["mu_c"] = rng.uniform(0.05, 1.0)
        pad["mu_s"] = pad["mu_c"] * rng.uniform(1.0, 2.0)
        pad["sigma_0"] = 10.0 ** rng.uniform(5.0, 6.0)
        pad["sigma_1"] = rng.uniform(0.0, 200.0)
        pad["r"] = rng.uniform(0.003, 0.015)
        pad["cop"] = rng.uniform(-0.005, 0.005, 2)
        load_pad(pad, rng.uniform(0.1, 30.0))
        pad["twist"] = rng.normal(size=3) * 10.0 ** rng.uniform(-6.0, -1.0)
        own[SPEED_CAP] = np.where(rng.random(size) < 0.5, np.inf, 10.0 ** rng.uniform(-6.0, -2.0, size))
        length, angle = pad["mu_s"] / pad["sigma_0"] * rng.random(size), rng.uniform(0.0, 2.0 * np.pi, size)
        own[Z_X], own[Z_Y] = length * np.cos(angle), length * np.sin(angle)
    inertia = rng.uniform(0.05, 0.5), rng.uniform(2e-5, 2e-3)
    centre = tuple(rng.uniform(-0.03, 0.03, 2))
    free = rng.normal(size=3) * 10.0 ** rng.uniform(-9.0, -4.0) * (1.0, 1.0, 100.0)
    limits = np.array([set_friction_level(array[i], cells, i, H) for i in range(2)])
    return (array, cells, limits, inertia, centre, tuple(free)), float(limits @ array["normal"])


def displaced(pad, own, centre, q):
    """Deflections of a pad's cells and their displacements under a motion, (2, n) each [m]."""
    at = pad["cop"][:, None] + pad["r"] * np.array([own[X], own[Y]]) - np.array(centre)[:, None]
    return np.array([own[Z_X], own[Z_Y]]), np.array([q[0] - q[2] * at[1], q[1] + q[2] * at[0]])


def slipping(array, cells, centre, q):
    """Which cells of both pads slip under a motion."""
    moved = (
        np.hypot(*np.add(*displaced(pad, own, centre, q))) for pad, own in zip(array, cells, strict=True)
    )
    return np.concatenate(list(moved)) > cells[:, ELASTIC_LIMIT].ravel()


def potential(q, array, cells, _, inertia, centre, free):
    """Potential whose gradient is the momentum balance; written from the equations alone."""
    mass = np.array([inertia[0], inertia[0], inertia[1]])
    value = 0.5 / H**2 * np.sum(mass * (q - free) ** 2)
    for pad, own in zip(array, cells, strict=True):
        z, delta = displaced(pad, own, centre, q)
        length = np.hypot(*(z + delta))
        stuck = 0.5 * length**2
        slipping = own[ELASTIC_LIMIT] * (length - 0.5 * own[ELASTIC_LIMIT])
        energy = (pad["sigma_0"] + pad["sigma_1"] / H) * np.where(
            length <= own[ELASTIC_LIMIT], stuck, slipping
        )
        energy += -pad["sigma_1"] / H * np.sum(z * delta, axis=0)
        energy += 0.5 * pad["sigma_2"] / H * np.sum(delta**2, axis=0)
        value += pad["normal"] * own[LOAD] @ energy
    return value


@settings(deadline=None, max_examples=150)
@given(problems(), st.tuples(*[st.floats(-1.0, 1.0)] * 3))
@pytest.mark.slow
def test_the_balance_is_met_from_any_guess(problem, guess):
    data, limit = problem
    for start in (data[-1], (0.0, 0.0, 0.0), tuple(1e-5 * g for g in guess)):
        motion = solve_motion(*data, start, H)
        residual, _ = assemble(*data, motion, H)
        assert norm(residual, data[0]["r"][0]) <= 1e-9 * limit  # the solver stops at 1e-10


@settings(deadline=None, max_examples=40)
@given(problems())
def test_no_other_motion_has_less_potential(problem):
    data, limit = problem
    motion = np.array(solve_motion(*data, data[-1], H))
    unit = limit * 1e-6  # energy of a slip of 1 um
    scale = np.array([1e-6, 1e-6, 1e-4])
    least = potential(motion, *data)
    found = minimize(
        lambda q: (potential(q * scale, *data) - least) / unit,
        motion / scale + (3.0, -2.0, 1.0),
        method="Nelder-Mead",
        options={"xatol": 1e-5, "fatol": 1e-12, "maxiter": 4000, "maxfev": 4000},
    )
    assert found.fun >= -1e-9  # rounding of the potential, up to 1e3 units, leaves 1e-12
    # curvature of at least mass / h^2 turns the minimiser's excess into a distance
    away = (found.x * scale - motion) / H
    inertia = data[3]
    kinetic = 0.5 * (inertia[0] * (away[0] ** 2 + away[1] ** 2) + inertia[1] * away[2] ** 2)
    assert kinetic <= max(found.fun, 0.0) * unit + 1e-9 * unit


@settings(deadline=None, max_examples=60)
@given(problems())
def test_the_derivative_is_that_of_the_residual(problem):
    data, _ = problem
    array, cells, _, _, centre, free = data
    at = np.array(free)
    _, j = assemble(*data, tuple(at), H)
    jacobian = np.array([[j[0], j[3], j[4]], [j[3], j[1], j[5]], [j[4], j[5], j[2]]])
    assert np.all(np.linalg.eigvalsh(jacobian) > 0.0)
    step = np.array([1e-12, 1e-12, 1e-10])
    for a in range(3):
        shift = step * (np.arange(3) == a)
        # where a cell breaks away the derivative jumps: within a difference that would be neither of the two
        assume(np.array_equal(*(slipping(array, cells, centre, at + s) for s in (shift, -shift))))
        ahead, _ = assemble(*data, tuple(at + shift), H)
        behind, _ = assemble(*data, tuple(at - shift), H)
        slope = (np.array(ahead) - np.array(behind)) / (2.0 * step[a])
        # rounding: 1e-16 of 1000 N over 1e-12 m; curvature: the square of 1e-12 over bristles of 5e-8 m
        size = np.sqrt(np.diag(jacobian) * jacobian[a, a])
        assert np.all(np.abs(slope - jacobian[:, a]) <= 1e-6 * size + 1e-13 / step[a])


@pytest.mark.parametrize("pressure", ["uniform", "hertz", "rim"])
@pytest.mark.parametrize(("start", "load"), [(0.0, 5.0), (2e-4, 10.0), (5e-3, 7.0)])
def test_in_translation_a_patch_is_an_ellipsoid(pressure, start, load):
    """In stick under a load step, in slip that gets faster, in slip that comes to rest."""
    patchy, cells = pads(2, r=0.01, normal=2.0, **LAW), patches(pressure, 7)
    plain, velocity = patchy.copy(), np.full((2, 3), (0.0, -start, 0.0))
    if start > 0.0:
        plain["slip_speed"], cells[:, SPEED_CAP] = start, np.inf
        patchy["twist"][:, 1] = -start
        plain["z"][:, 1] = cells[:, Z_Y] = -LAW["mu_s"] / LAW["sigma_0"]
    state = (0.2, 5e-4), (0.0, 0.0)
    for _ in range(40):
        free = [tuple(v * H - (0.0, load * H**2, 0.0)) for v in velocity]
        velocity[0] = step_pads(patchy, cells, *state, free[0], free[0], H)
        velocity[1] = step_pads(plain, None, *state, free[1], free[1], H)
        velocity /= H
        # the solver's 1e-10 of the limit of 2 N is 3e-13 m/s in a sub-step; falling friction amplifies it
        # with the square of the speed up to v_s: 25 times
        np.testing.assert_allclose(velocity[0], velocity[1], atol=1e-10)
    assert (abs(velocity[1, 1]) > 1e-3) == (start == 2e-4)


def test_a_pad_without_normal_force_takes_no_part():
    array, cells = pads(2, r=0.01, **LAW), patches("uniform", 5)
    array["normal"] = 4.0, 0.0
    cells[:, Z_X] = 1e-7
    alone, own = array[:1].copy(), cells[:1].copy()
    state = (0.2, 5e-4), (0.01, 0.0), (1e-5, 2e-5, 1e-4), (0.0, 0.0, 0.0), H
    assert step_pads(array, cells, *state) == step_pads(alone, own, *state)
    np.testing.assert_array_equal(cells[0], own[0])
    np.testing.assert_array_equal(array["wrench"][1], 0.0)
    np.testing.assert_array_equal(cells[1, Z_X], 0.0)
