"""Stick and slip under weight against a rigid Coulomb-Stribeck contact, integrated independently."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from lab.validation.halving import SIZE, smooth_grip, stick_slip_grip
from slipgym.validation.bench import Bench, Friction

MASS, GRAVITY, V_S, SIGMA_2 = 0.2, 9.81, 1e-3, 0.2
LAG, DEAD, STEP = 0.012, 0.004, 1 / 120
START = 2.2  # [N]


def rigid_slide(grip, duration: float) -> float:
    """Distance slid by a mass that sticks rigidly until its weight exceeds mu_s sum f_n [m]."""
    mu_s, mu_c = Friction().mu_s, Friction().mu_c
    starts = np.arange(0.0, duration, STEP)
    limit = MASS * GRAVITY / (2.0 * mu_s)
    edges = np.concatenate([[0.0], starts + DEAD, [duration]])
    commands = [START, *map(grip, starts)]
    force, state, stuck = START, np.zeros(2), True
    for begin, end, command in zip(edges[:-1], edges[1:], commands, strict=True):
        if begin >= duration:
            break

        def normal(t, begin=begin, command=command, force=force):
            return command + (force - command) * math.exp(-(t - begin) / LAG)

        def motion(t, y, normal=normal):
            level = mu_c + (mu_s - mu_c) * math.exp(-((y[1] / V_S) ** 2)) + SIGMA_2 * y[1]
            return [y[1], GRAVITY - 2.0 * normal(t) * level / MASS]

        def stopped(t, y):
            return y[1]

        stopped.terminal, stopped.direction = True, -1
        t, end = begin, min(end, duration)
        if stuck and normal(end) < limit:
            if normal(begin) > limit:
                t = brentq(lambda s, normal=normal: normal(s) - limit, begin, end)
            stuck, state[1] = False, 1e-9
        if not stuck:
            found = solve_ivp(motion, (t, end), state, events=stopped, rtol=1e-9, atol=1e-12, max_step=1e-3)
            state, stuck = found.y[:, -1].copy(), found.status == 1
        force = normal(end)
    return state[0]


def slide(grip, duration: float, sigma_0: float, engine_steps: int, substep: float) -> float:
    """The same on the bench [m]."""
    overrides = {
        "physics": {"engine_steps": engine_steps, "substep_max": substep},
        "contact": {"sigma_0": sigma_0},
    }
    with Bench(overrides, size=SIZE) as bench:
        bench.settle()
        bench.settle(force=lambda _: START)
        return -bench.run(duration, force=grip).slip[-1, 1]


@pytest.mark.parametrize("grip", [smooth_grip, stick_slip_grip])
@pytest.mark.parametrize("sigma_0", [1e5, 1e6])
def test_a_slide_from_stick_converges_to_the_rigid_contact(grip, sigma_0):
    expected = rigid_slide(grip, 1.0)
    assert expected > 0.01
    default = slide(grip, 1.0, sigma_0, 4, 2.5e-4) - expected
    fine = slide(grip, 1.0, sigma_0, 16, 6.25e-5) - expected
    # Half a sub-step by which a contact of first order would be ahead: 0.125 ms at up to 0.16 m/s
    assert abs(default - fine) < 2e-5
    # Bristles move while they stick, the softer the faster, and so break away with a start
    assert abs(fine) < 1e-4
