"""Every reset option takes effect, and only for its episode."""

import gymnasium as gym
import numpy as np
import pytest

from slipgym.tasks import TASKS
from tests.envs.conftest import CARRYING

HOLD, LINEAR = "slipgym/Hold-v0", "slipgym/LinearSlip-v0"
FIRM = np.float32([0.2])
CHANGES = {
    "material": "plastic",
    "mu_s": 0.9,
    "mu_c": 0.3,
    "r": 0.006,
    "finger_friction": (0.9, 1.1),
    "finger_radius": (0.9, 1.0),
    "cop_offset": ((0.001, 0.0), (0.0, -0.001)),
    "finger_lag": (0.5, 1.5),
    "force_gain": (0.9, 1.2),
    "object_mass": 0.33,
    "object_size": (0.4, 0.02, 0.26),
    "com_offset": (0.01, 0.02),
    "initial_force": 12.0,
    "randomization_scale": 0.5,
    "distance": 0.02,
    "angle": 0.3,
    "turn": 0.3,
    "slide": 0.015,
    "heading": 0.2,
    "direction": -1,  # seed 0 draws 1
    "duration": 0.5,
    "settle": 0.1,
    "hold": 0.1,
    "tolerance": 0.01,
    "slide_tolerance": 0.01,
    "tilt_tolerance": 0.01,
    "angle_tolerance": 0.1,
    "shake_amplitude": 0.001,
    "shake_pitch": 0.0,
    "shake_frequency": (0.5, 0.6),
    "poke_impulse": (0.2, 0.3),
    "poke_interval": (0.01, 0.02),
    "economy": 1.2,
    "grip_limit": 1.5,
    "grip_limit_start": 0.5,
    "allowance": 1.2,
    "lift_off": 0.5,
    "acceleration": (1.0, 2.0),
    "accuracy": 0.2,
    "commitment": 0.5,
}
LIFTED = {"slipgym/Carry-v0", "slipgym/FragileHold-v0"}
"""Neither tilt nor slip before the wrist moves."""
UNSEEN = {("slipgym/Explore-v0", name) for name in ("accuracy", "commitment", "tilt_tolerance")}
"""Options that show in a guess, or in a turn in the grip: tests/tasks/test_explore.py."""
TASKS_OF = {
    name: [
        task.id
        for task in TASKS.values()
        if name in task.options.model_fields and task.id not in CARRYING and (task.id, name) not in UNSEEN
    ]
    for name in CHANGES
}
QUICK = [f"{ids[k % len(ids)]}-{name}" for k, (name, ids) in enumerate(TASKS_OF.items()) if ids]
"""Every option in one task, one task after the other; the other cases are slow."""


@pytest.fixture(scope="module")
def kept():
    """Makes an environment once for all tests of this file."""
    made = {}

    def factory(env_id, randomization):
        arguments = {"action_mode": "grip_force", "randomization": randomization}
        if (env_id, randomization) not in made:
            made[env_id, randomization] = gym.make(env_id, **arguments).unwrapped
        return made[env_id, randomization]

    yield factory
    for env in made.values():
        env.close()


@pytest.fixture(scope="module")
def plain():
    """What an environment says without the tried option, once for all tests of this file."""
    said = {}

    def first(play, env, steps, others):
        key = env.spec.id, env.spec.kwargs["randomization"], steps, str(others)
        if key not in said:
            said[key] = play(env, steps=steps, options=others)
        return said[key]

    return first


def test_every_option_is_tried_and_explained(make, env_id):
    fields = make(env_id).task.options.model_fields
    assert set(fields) <= {*CHANGES, "wrist_roll"}  # that one needs tilt: tests/world/test_tilt.py
    assert all(field.description for field in fields.values())


@pytest.mark.quick_cases(*QUICK)
@pytest.mark.parametrize("name", CHANGES)
def test_an_option_changes_its_episode_and_no_other(kept, plain, env_id, play, name):
    env = kept(env_id, "train" if name == "randomization_scale" else "none")
    if name not in env.task.options.model_fields:
        pytest.skip("not an option of this task")
    if (env_id, name) in UNSEEN:
        pytest.skip("nothing of it shows in random grips")
    late = name.startswith(("poke", "tilt", "grip_limit")) or env_id in LIFTED
    steps = 200 if late else 20
    others = {"grip_limit": 1.5, "duration": 1.5} if name == "grip_limit_start" else {}
    expected = plain(play, env, steps, others)
    assert play(env, steps=steps, options={**others, name: CHANGES[name]}) != expected
    assert play(env, steps=steps, options=others) == expected


@pytest.mark.parametrize(("name", "column"), [("mu_s", 0), ("mu_c", 1), ("r", 2)])
def test_friction_options_are_the_truth(make, env_id, name, column):
    _, info = make(env_id).reset(seed=0, options={name: CHANGES[name]})
    assert info["true"][column] == CHANGES[name]


def test_the_mass_is_what_the_fingers_carry(make, hanging_id):
    env = make(hanging_id, sensors="ideal")
    observation, _ = env.reset(seed=0, options={"object_mass": 0.1})
    load = observation[[0, 1]] + observation[[7, 8]]
    assert np.hypot(*load) == pytest.approx(0.1 * 9.81, rel=1e-3)


def test_a_shifted_centre_of_mass_is_a_torque(make):
    env = make(LINEAR, sensors="ideal")
    observation, _ = env.reset(seed=0, options={"com_offset": (0.01, 0.0), "object_mass": 0.2})
    assert abs(observation[3]) + abs(observation[10]) == pytest.approx(0.2 * 9.81 * 0.01, rel=1e-2)


def test_the_initial_force_is_on(make, env_id):
    _, info = make(env_id).reset(seed=0, options={"initial_force": 10.0})
    np.testing.assert_allclose(info["grip_force"], 10.0)


def length(env, options) -> int:
    env.reset(seed=0, options=options)
    steps, over = 0, False
    while not over:
        _, _, terminated, truncated, _ = env.step(FIRM)
        steps, over = steps + 1, terminated or truncated
    assert truncated
    return steps


def test_times_set_the_length(make):
    assert length(make(LINEAR), {"settle": 0.5, "duration": 1.0, "hold": 0.25}) == 210
    assert length(make(HOLD), {"duration": 1.5}) == 180


def test_the_distance_is_where_the_reference_ends(make):
    env = make(LINEAR)
    env.reset(seed=0, options={"distance": 0.013, "duration": 0.5, "settle": 0.0})
    for _ in range(61):
        info = env.step(FIRM)[4]
    np.testing.assert_allclose(info["reference"], [0.013, 0.0, 0.0], atol=1e-12)


@pytest.mark.parametrize(("tolerance", "success"), [(0.005, False), (0.011, True)])
def test_the_tolerance_decides_about_success(make, tolerance, success):
    env = make(LINEAR)
    env.reset(
        seed=0,
        options={"distance": 0.01, "duration": 0.2, "settle": 0.0, "hold": 0.0, "tolerance": tolerance},
    )
    for _ in range(24):
        _, _, _, truncated, info = env.step(FIRM)
    assert truncated
    assert info["is_success"] is success


def test_without_shaking_the_wrist_rests(make):
    env = make(HOLD)
    speed = [column.name for column in env.columns].index("wrist_velocity_x")
    quiet = {"shake_amplitude": 0.0, "shake_pitch": 0.0}
    for options, moves in ((quiet, False), ({}, True)):
        env.reset(seed=0, options=options)
        seen = np.array([env.step(FIRM)[0][speed : speed + 3] for _ in range(30)])
        assert seen.any() == moves


def test_a_poke_carries_its_impulse(make):
    env = make(HOLD)
    env.reset(seed=0, options={"poke_interval": (0.3, 0.3), "poke_impulse": (0.2, 0.2)})
    impulse = np.zeros(2)
    for _ in range(60):
        env.step(FIRM)
        impulse += env.simulation.plant.world["external"][0, :2] / 120
    assert np.linalg.norm(impulse) == pytest.approx(0.2)
