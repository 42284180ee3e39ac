"""How long the sub-steps of the planar engine are."""

import math

import numpy as np
import pytest

from slipgym.config import load
from slipgym.world.plant import build
from slipgym.world.substep import RESOLVED
from slipgym.world.substep_length import FAST, FIRM, STEADY, STILL, longest_common_substep

PLANT = build(load())
CALM, SHORT = PLANT.world["calm_ticks"][0], PLANT.world["substep_ticks"][0]
ASKED = 4 * CALM
V_S = load().contact.stribeck_velocity


@pytest.fixture
def contact():
    """Makes a world with an object of 0.2 kg and 1e-4 kg m^2, a pad and the finger behind it, with 5 N."""

    def make(**fields):
        plant = build(load())
        world, pad, finger = plant.world[0], plant.pads[0, 0], plant.fingers[0, 0]
        world["mass"], world["inertia"] = 0.2, 1e-4
        pad["mu_s"], pad["mu_c"] = 0.6, 0.4
        finger["force"] = finger["command"] = finger["contact_force"] = 5.0
        for name, value in fields.items():
            record = next(row for row in (world, pad, finger) if name in row.dtype.names)
            record[name] = value
        return world, pad, finger

    return make


LIMIT, R = 3.0, 0.01  # of the fixture's pad [N, m]
STIFFNESS = 5.0 * load().contact.sigma_0  # of its bristles [N/m]


@pytest.mark.parametrize(
    ("carried", "expected"),
    [
        ((0.0, 0.99 * FAST * LIMIT, 0.0), ASKED),
        ((0.0, 0.99 * FIRM * LIMIT, 0.0), CALM),
        ((0.0, 1.01 * FIRM * LIMIT, 0.0), SHORT),
        ((0.0, 0.0, 0.99 * FAST * LIMIT * R), ASKED),
        ((0.0, 0.0, 0.99 * FIRM * LIMIT * R), CALM),
        ((0.0, 0.0, 1.01 * FIRM * LIMIT * R), SHORT),
    ],
)
def test_long_sub_steps_are_for_a_firm_grip(contact, carried, expected):
    world, pad, finger = contact(wrench=carried)
    load = 2.0 * np.array(carried)  # on both pads
    assert longest_common_substep(world, (pad,), None, (finger,), tuple(load), ASKED) == expected


@pytest.mark.parametrize(
    ("fields", "expected"),
    [
        ({"force": 4.5, "command": 3.0}, SHORT),  # within the sub-step it falls below the load
        ({"command": 4.0}, CALM),  # it would later on
        ({"command": 8.0}, CALM),
        ({"slip_speed": V_S, "slip_rate": 1.0}, SHORT),
        ({"slip_speed": 3 * V_S, "slip_rate": 1.0}, SHORT),
        ({"force": 5.0, "command": 0.0}, SHORT),
        ({"force": 0.0, "command": 0.0, "contact_force": 0.0}, ASKED),
    ],
)
def test_but_not_for_what_lets_go_or_slips(contact, fields, expected):
    world, pad, finger = contact(wrench=(0.0, 0.9 * FIRM * LIMIT, 0.0), **fields)
    assert (
        longest_common_substep(world, (pad,), None, (finger,), (0.0, 1.8 * FIRM * LIMIT, 0.0), ASKED)
        == expected
    )


@pytest.mark.parametrize("compliance", [5e-5, 1e-4, 2e-4])
def test_a_vibration_on_rubber_takes_sub_steps_that_resolve_it(contact, compliance):
    moving = {"relative_velocity": (0.0, 0.01, 0.0), "normal": 5.0}
    world, pad, finger = contact(compliance=compliance, **moving)
    ticks = longest_common_substep(world, (pad,), np.zeros((1, 0)), (finger,), (0.0, 0.0, 0.0), ASKED)
    omega = math.sqrt(2.0 / (compliance + 1.0 / STIFFNESS) * (1.0 / 0.2 + R * R / 1e-4))
    assert SHORT < ticks <= RESOLVED / (omega * world["tick_length"]) < ticks + 1
    world, pad, finger = contact(**moving)
    assert longest_common_substep(world, (pad,), None, (finger,), (0.0, 0.0, 0.0), ASKED) == SHORT


@pytest.mark.parametrize("speed", [5, 20, 100])
@pytest.mark.parametrize("force", [0.0, 0.5, 2.0])
def test_a_slide_takes_sub_steps_by_its_acceleration(contact, force, speed):
    """The change of its speed is at most STEADY of what lies above 3 v_s, where friction is flat."""
    carried = np.array([0.0, 2.0, 0.0])
    world, pad, finger = contact(wrench=carried, slip_speed=speed * V_S, slip_rate=1e-9)
    load = 2.0 * carried - np.array([0.0, force, 0.0])
    ticks = longest_common_substep(world, (pad,), None, (finger,), tuple(load), ASKED)
    allowed = STEADY * (speed - 3.0) * V_S
    longest = allowed * 0.2 / force / world["tick_length"] if force else ASKED
    assert ticks == min(max(int(longest), SHORT), ASKED)


def test_and_by_the_change_of_its_grip(contact):
    world, pad, finger = contact(wrench=(0.0, 2.0, 0.0), slip_speed=50 * V_S, slip_rate=1e-9, command=6.0)
    ticks = longest_common_substep(world, (pad,), None, (finger,), (0.0, 4.0, 0.0), ASKED)
    mobility = 1.0 / 0.2 + R**2 / 1e-4
    longest = (STEADY * 47 * V_S / (2.0 * 0.4 * mobility * 1.0 / finger["lag"])) ** 0.5
    assert ticks == int(longest / world["tick_length"])


@pytest.mark.parametrize(("share", "expected"), [(0.99, ASKED), (1.01, SHORT)])
@pytest.mark.parametrize(
    ("off", "speed"),
    [
        ((0.0, 1.0, 0.0), (0.0, 0.0, 0.0)),
        ((0.0, 0.0, R), (0.0, 0.0, 0.0)),
        ((0.0, 0.0, 0.0), (1.0 / math.sqrt(STIFFNESS * 0.1), 0.0, 0.0)),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 1.0 / math.sqrt(STIFFNESS * 0.5e-4))),
        ((0.0, 0.6, 0.0), (0.8 / math.sqrt(STIFFNESS * 0.1), 0.0, 0.0)),
    ],
)
def test_nor_for_vibration(contact, off, speed, share, expected):
    """Its amplitude counts, at rest on one side or in motion through the middle: f = v (k m)^0.5."""
    amplitude = share * STILL * LIMIT
    world, pad, finger = contact(wrench=(0.0, 1.0, 0.0), relative_velocity=amplitude * np.array(speed))
    load = 2.0 * (np.array([0.0, 1.0, 0.0]) + amplitude * np.array(off))
    assert longest_common_substep(world, (pad,), None, (finger,), tuple(load), ASKED) == expected


@pytest.mark.parametrize(
    "load", [(0.0, 2.1 * FIRM * LIMIT, 0.0), (0.0, 0.0, 2.1 * FIRM * LIMIT * R), (0.0, 0.2 * LIMIT, 0.0)]
)
def test_nor_for_a_load_that_is_about_to_change(contact, load):
    world, pad, finger = contact()
    assert longest_common_substep(world, (pad,), None, (finger,), load, ASKED) == SHORT
