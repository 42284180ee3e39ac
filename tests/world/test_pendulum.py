"""An object that swings between the pads: a pendulum with the friction of the limit surface."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from slipgym.tasks.episode import trapezoid
from slipgym.validation.bench import Bench, Friction

DEPTH = 0.1  # of the centre of mass below the pads [m]
BOX = {"size": (0.05, 0.03, 0.25), "grasp_offset": (0.0, DEPTH), "mass": 0.2}
SOFTENING = 1e-6  # [m/s]; friction is u / sqrt(u^2 + s^2)


def turning_points(angle: np.ndarray, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and angles of the extremes, by parabolas through three samples each."""
    middle = np.flatnonzero(np.diff(np.sign(np.diff(angle)))) + 1
    a, b, c = angle[middle - 1], angle[middle], angle[middle + 1]
    shift = 0.5 * (a - c) / (a - 2.0 * b + c)
    return (middle + 1 + shift) * dt, b - 0.25 * (a - c) * shift


def test_a_free_hinge_swings_like_a_pendulum_and_loses_what_the_limit_surface_takes():
    """Almost free: the torque takes 0.01 rad from each half swing, presliding is 5e-4 rad."""
    friction, grip, start = Friction(mu_s=0.1, mu_c=0.1, r=2e-4), 25.0, 0.3
    with Bench(friction=friction, force=grip, wrist=(0.0, 0.0, start), **BOX) as bench:
        trace = bench.run(4.0)
        gravity, mass = bench.config.physics.gravity, bench.box.mass
        inertia, dt = bench.box.inertia + mass * DEPTH**2, bench.step_time
    times, angles = turning_points(trace.position[:, 2], dt)
    swings = np.abs(np.concatenate(([start], angles)))
    assert len(swings) == 11
    # dry friction shifts the centre of each half swing but not its time; the series is the pendulum's
    amplitude = 0.5 * (swings[1:-1] + swings[2:])
    half = math.pi * math.sqrt(inertia / (mass * gravity * DEPTH)) * (1.0 + amplitude**2 / 16.0)
    np.testing.assert_allclose(np.diff(times), half, rtol=0.01)
    # the weight takes its share of the limit, the torque has the rest; at the lowest point the centripetal
    # force adds 9 % to the weight in the first swing, which takes 1.4 % of the torque
    limit = friction.mu_c * 2.0 * grip
    torque = friction.r * math.sqrt(limit**2 - (mass * gravity) ** 2)
    lost = mass * gravity * DEPTH * -np.diff(1.0 - np.cos(swings))
    np.testing.assert_allclose(lost, torque * (swings[:-1] + swings[1:]), rtol=0.02)
    assert swings[-1] < 0.75 * start


@pytest.mark.parametrize(("grip", "turn"), [(4.2, 1.05), (2.9, -1.05)])
def test_a_turning_gripper_agrees_with_an_independent_integration(grip, turn):
    """Trapezoid of the wrist's pitch; the object is dragged along, lets go, swings and slides."""
    friction, duration, rate = Friction(mu_s=0.4, mu_c=0.4, r=0.003), 3.0, 120
    pitch_rate = [trapezoid(i / rate - 0.5, turn, duration)[1] for i in range(5 * rate + 2)]
    with Bench({"physics": {"control_rate": rate}}, friction=friction, force=grip, **BOX) as bench:
        world = bench.plant.world[0]
        state = np.array([*world["com"], world["angle"], *world["velocity"]])
        trace = bench.run(5.0, wrist=lambda t: (0.0, 0.0, pitch_rate[round(t * rate)]))
        mass, inertia, r = bench.box.mass, bench.box.inertia, friction.r
        gravity, viscous = bench.config.physics.gravity, bench.config.contact.sigma_2
    ticks = np.arange(len(pitch_rate)) / rate

    def derivative(t, s):
        x, z, _, vx, vz, omega = s
        # slip at the pad centre, the origin, about which the pads turn
        u = np.array([vx + omega * z, vz - omega * x, r * (omega - np.interp(t, ticks, pitch_rate))])
        f = -2.0 * grip * (friction.mu_c / math.sqrt(u @ u + SOFTENING**2) + viscous) * u
        torque = r * f[2] - x * f[1] + z * f[0]
        return [vx, vz, omega, f[0] / mass, f[1] / mass - gravity, torque / inertia]

    times = np.linspace(0.0, 5.0, len(trace.time) + 1)
    solution = solve_ivp(derivative, (0.0, 5.0), state, "LSODA", times, rtol=1e-8, atol=1e-10, max_step=0.01)
    away = np.abs(trace.position - solution.y[:3, 1:].T)
    assert np.hypot(*trace.slip[-1, :2]) > 1e-3
    assert abs(trace.slip[-1, 2]) > 0.8
    assert np.hypot(away[:, 0], away[:, 1]).max() < 2e-4
    assert math.degrees(away[:, 2].max()) < 0.2
