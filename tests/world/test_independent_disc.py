"""A box that slides and turns on distributed pads against an integration with the exact uniform disc."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from estimator.limit_surface import disc_friction
from slipgym.validation.bench import Bench, Friction

MU, RADIUS = 0.4, 0.015
TINY = 1e-12


def equations(bench: Bench, grip: float):
    """Coulomb friction of two uniform discs, at rest at the origin."""
    m, inertia, g = bench.box.mass, bench.box.inertia, bench.config.physics.gravity

    def derivative(t, state):
        x, z, _, vx, vz, omega = state
        ux, uz = vx + omega * z, vz - omega * x  # at the origin, from the centre of mass
        speed, spin = max(math.hypot(ux, uz), TINY), max(abs(omega), TINY)
        force, torque = disc_friction(speed / (RADIUS * spin))
        limit = 2.0 * grip * MU
        fx, fz = -limit * force * ux / speed, -limit * force * uz / speed
        tau = -limit * RADIUS * torque * omega / spin
        return [vx, vz, omega, fx / m, fz / m - g, (tau - x * fz + z * fx) / inertia]

    return derivative


@pytest.mark.parametrize(
    ("grip", "com_offset", "duration"), [(2.4, (-0.01, 0.02), 1.0), (2.45, (0.012, -0.03), 2.0)]
)
def test_a_slide_agrees_with_the_exact_disc(grip, com_offset, duration):
    with Bench(
        {"contact": {"sigma_2": 0.0}},
        friction=Friction(mu_s=MU, mu_c=MU),
        force=20.0,
        contact="distributed",
        com_offset=com_offset,
        size=(0.4, 0.03, 0.8),
    ) as bench:
        start = bench.settle()
        bench.run(0.2, force=lambda _: grip)  # the force loop has settled to exp(-16)
        world = bench.plant.world[0]
        state = np.array([*world["com"], world["angle"], *world["velocity"]])
        trace = bench.run(duration, force=lambda _: grip)
        times = np.linspace(0.0, duration, len(trace.time) + 1)
        motion = equations(bench, grip)
        solution = solve_ivp(motion, (0.0, duration), state, "LSODA", times, rtol=1e-9, atol=1e-12)
    away = np.abs(trace.position - solution.y[:3, 1:].T)
    assert np.abs(trace.slip[-1, :2] - start.slip[-1, :2]).max() > 0.1
    assert abs(trace.slip[-1, 2]) > 0.2
    # half a sub-step of 0.25 ms at 0.25 m/s is 0.03 mm; cells leave as much again (11 to 41 of them)
    assert np.hypot(away[:, 0], away[:, 1]).max() < 1e-4
    assert math.degrees(away[:, 2].max()) < 0.1
