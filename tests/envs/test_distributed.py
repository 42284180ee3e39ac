"""Environments with the distributed contact: r, its limits, the same bits, the checkers."""

import json
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

pytestmark = pytest.mark.quick_tasks

IDS = "slipgym/LinearSlip-v0", "slipgym/Hold-v0"
PATCH = {"contact": "distributed"}
SMALL = {**PATCH, "config": {"contact": {"cells": 7}}}
SCRIPT = str(Path(__file__).with_name("rollout.py"))


@pytest.mark.parametrize(
    ("contact", "r"),
    [
        ({}, 0.010),
        ({"pressure": "hertz"}, 0.015 * 3.0 * np.pi / 16.0),
        ({"pressure": "rim"}, 0.015),
        ({"radius": 0.006}, 0.006),
    ],
)
@pytest.mark.quick_tasks
@pytest.mark.parametrize("model", ["ellipsoid", "distributed"])
def test_the_true_r_is_that_of_the_pressure_on_the_pad(make, env_id, model, contact, r):
    if "Explore" in env_id:
        pytest.skip("Explore draws r in every episode")
    env = make(env_id, contact=model, friction_source="true", config={"contact": contact})
    observation, info = env.reset(seed=0)
    r = env.settings.radius or r  # a task with fingertips of its own
    assert info["true"][2] == pytest.approx(r, rel=1e-12)
    column = [column.name for column in env.columns].index("r")
    assert observation[column] == pytest.approx(r, rel=1e-6)


def spin_torque(env, **options) -> float:
    """Torque of both pads over mu_c sum f_n while the box spins between them, weight aside [m]."""
    env.reset(seed=0, options={"com_offset": (0.0, 0.0), **options})
    world, plant = env.simulation.world, env.simulation.plant
    world.disturb(np.array([0.0, 0.2 * 9.81, 0.5]))
    env.simulation._settle(10.0)
    env.simulation._settle(10.0)
    assert abs(plant.world["slip_twist"][0, 2]) > 3.0
    return float(-plant.pads["wrench"][0, :, 2].sum() / (plant.pads["mu_c"] * plant.pads["normal"]).sum())


@pytest.mark.parametrize("pressure", ["uniform", "hertz", "rim"])
@pytest.mark.parametrize("r", [None, 0.004])
def test_a_spinning_box_feels_the_r_asked_for(make, pressure, r):
    contact = {"pressure": pressure, "cells": 9, "sigma_2": 0.0}
    env = make(**PATCH, config={"contact": contact, "object": {"mass": 0.2}})
    torque = spin_torque(env, object_mass=0.2, **({} if r is None else {"r": r}))
    # of the cells near the centre of rotation, which is off by the rest of the weight, one may differ: 1/81
    assert torque == pytest.approx(env.simulation.true_friction[0, 2], rel=1.5e-2)


def test_an_r_for_which_the_pad_has_no_room_is_refused(make, env_id):
    with pytest.raises(
        ValueError, match=r"contact.radius = 0.012 m.*uniform patch of 0.018 m.*at most 0.01 m"
    ):
        make(env_id, **PATCH, config={"contact": {"radius": 0.012}})
    env = make(env_id, **PATCH, config={"contact": {"pressure": "rim"}})
    env.reset(seed=0, options={"r": 0.015})
    with pytest.raises(ValueError, match=r"option r = 0.016 m.*rim patch"):
        env.reset(options={"r": 0.016})


def test_a_configuration_may_choose_the_model(make, env_id):
    assert make(env_id, config={"contact": {"model": "distributed"}}).simulation.plant.cells is not None
    assert make(env_id).simulation.plant.cells is None


def test_the_number_of_cells_is_the_configured_one(make):
    sizes = [
        make(**PATCH, config={"contact": {"cells": n}}).simulation.plant.cells.shape[-1] for n in (5, 21)
    ]
    assert sizes[0] <= 25 < 21**2 / 2 < sizes[1] <= 21**2


@pytest.mark.slow
@pytest.mark.parametrize("name", IDS[:2])
def test_same_bits_in_another_process_and_after_other_episodes(python, name):
    arguments = SCRIPT, name, "--contact", "distributed"
    assert python(*arguments) == python(*arguments, "--disturbed")


def test_an_r_of_one_episode_leaves_no_trace(make, env_id, play):
    env = make(env_id, **SMALL)
    plain = play(env)
    assert play(env, options={"r": 0.007}) != plain
    assert play(env) == plain


def test_a_saved_state_holds_the_cells(make, env_id):
    actions = np.random.default_rng(0).uniform(-1.0, -0.6, (80, 1)).astype(np.float32)
    env = make(env_id, **SMALL)
    env.reset(seed=4, options={"com_offset": (0.004, 0.01)})
    for action in actions[:40]:
        env.step(action)
    state = env.get_state()
    first = [repr(env.step(action)) for action in actions[40:]]
    other = make(env_id, **SMALL)
    other.set_state(state)
    assert [repr(other.step(action)) for action in actions[40:]] == first


def test_gymnasium_checker(env_id):
    env = gym.make(env_id, **PATCH, render_mode="rgb_array")
    check_env(env.unwrapped)
    env.close()


def test_stable_baselines_checker(make, env_id):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    checker.check_env(make(env_id, **PATCH), warn=True)


def test_spec_survives_json(env_id):
    env = gym.make(env_id, **SMALL)
    again = gym.make(gym.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    assert again.spec.kwargs == SMALL
    assert json.loads(again.spec.to_json()) == json.loads(env.spec.to_json())
    env.close()
    again.close()
