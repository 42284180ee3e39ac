"""A sliding and turning object against an independent integration of its equations of motion."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from slipgym.validation.bench import Bench, Friction

MU, SIGMA_2 = 0.4, 0.2
SOFTENING = 1e-6  # [m/s]; friction is u / sqrt(u^2 + s^2): at 1 mm/s it is 5e-7 small


def equations(bench: Bench, grip: float):
    """Coulomb and viscous friction on the ellipsoid, pads at rest at the origin."""
    m, inertia, r = bench.box.mass, bench.box.inertia, bench.friction.r
    g = bench.config.physics.gravity

    def derivative(t, state):
        x, z, _, vx, vz, omega = state
        u = np.array([vx + omega * z, vz - omega * x, r * omega])  # at the origin, from the centre of mass
        f = -2.0 * grip * (MU / math.sqrt(u @ u + SOFTENING**2) + SIGMA_2) * u
        torque = r * f[2] - x * f[1] + z * f[0]
        return [vx, vz, omega, f[0] / m, f[1] / m - g, torque / inertia]

    return derivative


@pytest.mark.parametrize(
    ("grip", "com_offset", "duration"),
    [
        (2.2, (0.0, 0.0), 1.0),
        (2.2, (0.015, -0.005), 1.0),
        (2.4, (-0.01, 0.02), 1.0),
        (2.45, (0.012, -0.03), 2.0),
    ],
)
def test_a_slide_agrees_with_an_independent_integration(grip, com_offset, duration):
    friction = Friction(mu_s=MU, mu_c=MU)
    with Bench(friction=friction, force=20.0, com_offset=com_offset, size=(0.4, 0.03, 0.8)) as bench:
        start = bench.settle()
        bench.run(0.2, force=lambda _: grip)  # the force loop has settled to exp(-16)
        world = bench.plant.world[0]
        state = np.array([*world["com"], world["angle"], *world["velocity"]])
        trace = bench.run(duration, force=lambda _: grip)
        times = np.linspace(0.0, duration, len(trace.time) + 1)
        motion = equations(bench, grip)
        solution = solve_ivp(motion, (0.0, duration), state, "LSODA", times, rtol=1e-9, atol=1e-12)
    away = np.abs(trace.position - solution.y[:3, 1:].T)
    assert np.abs(trace.slip[-1, :2] - start.slip[-1, :2]).max() > 0.02
    if com_offset != (0.0, 0.0):
        assert abs(trace.slip[-1, 2]) > 0.2
    # backward Euler leads by half a sub-step of 0.25 ms: 0.04 mm at 0.3 m/s, 0.02 deg at 3 rad/s
    assert np.hypot(away[:, 0], away[:, 1]).max() < 1e-4
    assert math.degrees(away[:, 2].max()) < 0.1
