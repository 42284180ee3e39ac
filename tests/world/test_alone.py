"""The planar world without an engine: how long its sub-steps are, and what they keep exact."""

import math

import numpy as np
import pytest

from slipgym.config import load
from slipgym.validation.bench import Bench, Friction
from slipgym.validation.planar import slides
from slipgym.world.alone import CHANGE, FAST, FIRM, FLAT, longest_substep
from slipgym.world.plant import build

PLANT = build(load())
H = load().physics.planar_substep_max
CALM, SHORT = PLANT.world["calm_ticks"][0], PLANT.world["substep_ticks"][0]
ASKED = 4 * CALM
V_S = load().contact.stribeck_velocity


@pytest.fixture
def contact():
    """Makes a world, one of its pads and the finger that presses it with 5 N; fields can be set."""

    def make(**fields):
        plant = build(load())
        pad, finger = plant.pads[0, 0], plant.fingers[0, 0]
        pad["mu_s"], pad["mu_c"] = 0.6, 0.4
        finger["force"] = finger["command"] = finger["contact_force"] = 5.0
        for name, value in fields.items():
            record = pad if name in pad.dtype.names else finger
            record[name] = value
        return plant.world[0], pad, finger

    return make


LIMIT = 3.0  # of the fixture's pad [N]


@pytest.mark.parametrize(
    ("fields", "expected"),
    [
        ({"wrench": (0.0, 0.9 * FAST * LIMIT, 0.0)}, ASKED),
        ({"wrench": (0.0, 0.9 * FIRM * LIMIT, 0.0)}, CALM),
        ({"wrench": (0.0, 1.01 * FIRM * LIMIT, 0.0)}, SHORT),
        ({"wrench": (0.0, 0.0, 1.01 * FIRM * LIMIT * 0.01)}, SHORT),
        ({"wrench": (0.0, 0.9 * FIRM * LIMIT, 0.0), "command": 4.0}, SHORT),
        ({"wrench": (0.0, 0.9 * FIRM * LIMIT, 0.0), "command": 8.0}, CALM),
        ({"wrench": (0.0, 0.5, 0.0), "slip_speed": 2 * CHANGE * V_S}, SHORT),
        ({"slip_speed": 2 * FLAT * V_S, "slip_rate": 1.0}, CALM),
        ({"slip_speed": FLAT * V_S + 0.9 * H, "slip_rate": -1.0}, SHORT),
        ({"slip_speed": FLAT * V_S + 1.1 * H, "slip_rate": -1.0}, CALM),
        ({"slip_speed": V_S, "slip_rate": 0.9 * CHANGE * V_S / H}, CALM),
        ({"slip_speed": V_S, "slip_rate": 1.1 * CHANGE * V_S / H}, SHORT),
        ({"slip_speed": 0.5 * V_S, "slip_rate": -0.9 * CHANGE * V_S / H}, SHORT),
        ({"force": 0.0, "command": 0.0, "contact_force": 0.0}, ASKED),
        ({"force": 5.0, "command": 0.0}, SHORT),
    ],
)
def test_long_sub_steps_are_for_a_calm_contact(contact, fields, expected):
    world, pad, finger = contact(**fields)
    assert longest_substep(world, pad, None, finger, ASKED) == expected


def test_a_slide_under_a_closing_grip_has_the_exact_momentum():
    """Against the integral of the force loop's first-order lag, at mu_s = mu_c and without viscosity."""
    mu, low, high, mass = 0.4, 1.0, 2.0, 0.2
    overrides = {"contact": {"sigma_2": 0.0}, "gripper": {"dead_time": 0.0}}
    friction = Friction(mu_s=mu, mu_c=mu)
    with Bench(overrides, friction, force=low, mass=mass, engine="planar", size=(0.08, 0.03, 0.4)) as bench:
        gravity, lag = bench.config.physics.gravity, bench.config.gripper.lag
        before = bench.run(0.1).velocity[-1, 1]
        trace = bench.run(0.1, force=lambda _: high)
    t = trace.time - 0.1
    impulse = high * t + (low - high) * lag * (1.0 - np.exp(-t / lag))
    expected = before - gravity * t + 2.0 * mu * impulse / mass
    np.testing.assert_allclose(trace.velocity[:, 1], expected, rtol=1e-9)


def test_a_long_sub_step_holds_what_a_short_one_holds():
    """A wrist that jerks at 80 % of the limit: both stay within the bristles' reach and end alike."""
    ends = []
    for longest in (2e-3, 2.5e-4):
        with Bench({"physics": {"planar_substep_max": longest}}, force=2.4, engine="planar") as bench:
            bench.settle()
            pulse = bench.run(0.5, wrist=lambda t: (0.002 * math.sin(40.0 * t), 0.0, 0.0))
            ends.append(pulse.slip[-1])
            assert np.abs(pulse.slip[:, :2]).max() < bench.friction.mu_s / bench.config.contact.sigma_0
    np.testing.assert_allclose(*ends, atol=1e-8)


def test_slides_of_both_engines_agree():
    figures = list(slides(5))
    assert len(figures) == 4
    assert [figure for figure in figures if not figure.ok] == []
