"""The least grip of the rehearsal is that of a search by simulation, on rigid and on soft pads."""

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401
from slipgym.tasks import TASKS
from slipgym.tasks.least_grip import least_grip, least_under

EPISODES = 12
FACTORS = 0.93, 1.05, 1.5
"""Constant grips over the least one of the rehearsal: too little, enough, and firm."""


def peaks(task, **arguments):
    """Largest slip in each constant grip [m], infinite after a drop; whether all are in range; by episode."""
    count = EPISODES * len(FACTORS)
    given = {"observation_mode": "dict", "level": "hard", "autoreset_mode": "Disabled"}
    envs = gym.make_vec(f"slipgym/{task}-v0", count, **given, **arguments).unwrapped
    seeds = np.repeat(np.arange(EPISODES), len(FACTORS)).tolist()
    observation, info = envs.reset(seed=seeds)
    names = [column.name for column in envs.privileged_columns]
    truth = dict(zip(names, observation["privileged"].T.astype(float), strict=True))
    gain = 0.5 * (truth["force_gain_1"] + truth["force_gain_2"])
    wanted, fingers = np.tile(FACTORS, EPISODES) * truth["least_grip"], envs.simulation.plant.fingers
    turned = np.sign(wanted - fingers["settled"].mean(axis=1)) * fingers["stiction"].mean(axis=1)
    force = (wanted + turned) / gain  # stiction holds the force back by so much
    action = (2.0 * (force - 0.6) / (25.0 - 0.6) - 1.0).astype(np.float32)[:, np.newaxis]
    largest, dropped = np.zeros(count), np.zeros(count, bool)
    for _ in range(envs.simulation.episode["steps"].max()):
        *_, terminated, _, info = envs.step(action)
        dropped |= terminated
        largest = np.maximum(largest, np.hypot(*info["slip"].T[:2]))
        if terminated.any():
            envs.reset(options={"reset_mask": terminated})
    envs.close()
    largest[dropped] = np.inf
    inside = (force > 0.6) & (force < 25.0)
    return largest.reshape(EPISODES, -1), inside.reshape(EPISODES, -1).all(axis=1)


@pytest.mark.parametrize(
    ("randomization", "sensors"), [("none", "realistic"), ("train", "realistic"), ("lab", "lab")]
)
def test_of_a_carried_object(randomization, sensors):
    """Beyond the least grip a pad only gives elastically; below it the object slides."""
    found, inside = peaks("FragileHold", randomization=randomization, sensors=sensors)
    assert inside.sum() >= EPISODES - 2
    less, enough, firm = found[inside].T
    assert (enough < 1.3 * firm + 2e-5).mean() >= 0.9  # a resonance of the swing depends on the grip
    assert (less > 2.0 * firm + 2e-5).mean() >= 0.9


def state(hand, **pads):
    """An episode's record with pads, friction 0.5 and r = 10 mm at 5 N."""
    made = hand("FragileHold")
    values = {"mu_s": 0.5, "r": 0.01, "axes": 1.0, "radii": 0.01, "finger_friction": 1.0}
    values |= {"jump_factor": 1.0, "region_factor": 1.0}
    for name, value in {**values, "reference_force": 5.0, "radius_max": 0.015, **pads}.items():
        made.episode[name] = value
    return made.episode


@pytest.mark.parametrize("load", [(0.0, 4.0, 0.0), (1.0, 3.0, 0.02)])
def test_of_rigid_pads_it_is_the_closed_form(hand, load):
    wanted = 0.5 * np.sqrt(load[0] ** 2 + load[1] ** 2 + (load[2] / 0.01) ** 2) / 0.5
    assert least_under(state(hand), load, 1.0) == pytest.approx(wanted, rel=1e-12)
    assert least_under(state(hand), load, 0.5) == pytest.approx(2.0 * wanted, rel=1e-12)


@pytest.mark.parametrize("exponents", [(0.3, 0.0), (-0.25, 0.0), (0.38, 1.0 / 3.0)])
@pytest.mark.parametrize("load", [(0.0, 0.5, 0.0), (1.0, 3.0, 0.02), (0.0, 12.0, 0.1)])
def test_of_soft_pads_it_is_on_the_limit_surface_at_that_grip(hand, exponents, load):
    episode = state(hand, load_exponent=exponents[0], radius_exponent=exponents[1])
    grip = least_under(episode, load, 1.0)
    r = min(0.01 * (grip / 5.0) ** exponents[1], 0.015)
    needed = 0.5 * np.sqrt(load[0] ** 2 + load[1] ** 2 + (load[2] / r) ** 2)
    assert 0.5 * (grip / 5.0) ** -exponents[0] * grip == pytest.approx(needed, rel=1e-3)


def test_the_weaker_pad_decides(hand):
    load = (0.0, 4.0, 0.0)
    assert least_under(state(hand, finger_friction=(0.8, 1.2)), load, 1.0) == pytest.approx(2.0 / (0.8 * 0.5))
    apart = state(hand, cops=((0.0, 0.001), (0.0, -0.001)))
    turned = least_under(apart, (0.0, 0.0, 0.02), 1.0)  # the torque loads pads that lie apart sideways, too
    arm = 2e-4 + 2e-6
    assert turned == pytest.approx(np.hypot(0.001 * 0.02, 1e-4 * 0.02 / 0.01) / arm / 0.5)


def test_it_is_that_of_the_object_at_rest(hand):
    made = hand("FragileHold")
    episode = state(hand)
    made.world["mass"], made.world["gravity"] = 0.4, 9.81
    made.world["axes"] = 1.0, 0.0
    assert least_grip(episode, made.world) == pytest.approx(0.4 * 9.81 / 2.0 / 0.5)


def test_wide_terms_have_a_slope_where_the_narrow_ones_are_flat(hand):
    for name, wide, narrow in (
        ("Hold", "still_wide", "still"),
        ("Carry", "still_wide", "still"),
        ("RotationalSlip", "tracking_wide", "tracking"),
        ("PivotTo", "angle_wide", "angle"),
    ):
        made = hand(name, **({"angle": 0.5} if name == "PivotTo" else {}))
        seen = [made.evaluate(1, slip=slip, angle=slip[2]) for slip in ((0.008, 0.0, 0.3), (0.010, 0.0, 0.2))]
        assert seen[0][narrow] < 0.01
        assert abs(seen[0][wide] - seen[1][wide]) > 0.05
        assert {term.scale for term in TASKS[name].terms if term.name == wide} == {0.0}


def test_too_firm_a_grip_is_paid_for_in_every_step(hand):
    carry, hold = hand("Carry"), hand("Hold", grip_limit=2.0)
    carry.episode["least_grip_now"], carry.episode["force_min"] = 2.0, 0.6
    carry.episode["mu_s"] = 0.5
    hold.episode["grip_limit"] = 4.0
    assert hold.evaluate(1)["overgrip"] == pytest.approx(-0.25)  # 5 N of 4 N
    hold.fingers["force"] = 3.9
    assert hold.evaluate(2)["overgrip"] == 0.0
    free = hand("Hold")
    assert free.evaluate(1)["overgrip"] == 0.0
