"""What the randomization draws holds for its episode, and what it makes happen happens."""

import math
import pickle
from pathlib import Path

import gymnasium as gym
import numpy as np
import pybullet
import pytest
from gymnasium.utils.env_checker import check_env

from slipgym.contact.pressure import OUTER_RADII
from slipgym.contact.records import LOAD, X, Y

pytestmark = pytest.mark.quick_tasks

SCRIPT = str(Path(__file__).with_name("rollout.py"))
PRESETS = ("train", "eval_ood")
LINEAR = "slipgym/LinearSlip-v0"
FIRM = np.float32([0.2])


def at(value: float) -> dict:
    return {"choices": [value]}


def sure(kind: str, **values: float) -> dict:
    """A randomization with one disturbance that every episode has."""
    return {"disturbances": [{"kind": kind, "probability": 1, **{k: at(v) for k, v in values.items()}}]}


def fitted(env) -> list:
    plant = env.simulation.plant
    arrays = plant.pads["sigma_0"], plant.fingers["lag"], plant.fingers["dead_ticks"]
    return [array.tolist() for array in (*arrays, plant.force_torque["noise"], plant.slip_sensors["delay"])]


@pytest.mark.parametrize("preset", PRESETS)
def test_both_checkers(make, env_id, preset):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    env = make(env_id, randomization=preset)
    check_env(env, skip_render_check=True)
    checker.check_env(env, warn=True)


def test_without_ranges_nothing_changes(make, env_id, play):
    assert play(make(env_id, randomization={})) == play(make(env_id))


@pytest.mark.slow
def test_same_bits_in_another_process_and_after_other_episodes(python):
    arguments = SCRIPT, "slipgym/Hold-v0", LINEAR, "--randomization", "eval_ood"
    assert python(*arguments) == python(*arguments, "--disturbed")


def test_scale_goes_from_the_configuration_to_the_full_ranges(make, hanging_id):
    env, plain = make(hanging_id, randomization="eval_ood"), make(hanging_id)
    plain.reset(seed=0)
    drawn = {}
    for scale in (1.0, 0.5, 0.0, None):
        _, info = env.reset(seed=3, options={"randomization_scale": scale})
        drawn[scale] = info["drawn"]
        if scale == 0.0:
            assert fitted(env) == fitted(plain)
            assert info["drawn"]["disturbances"] == ""
            assert info["true"][1] in {m.mu_c for m in env.config.materials.values()}
    assert drawn[None] == drawn[1.0]
    for name in ("lag", "dead_time", "noise_scale", "com_x", "size_scale", "mu_c", "mass"):
        ends = drawn[0.0][name], drawn[1.0][name]
        assert ends[0] != ends[1]
        assert drawn[0.5][name] == pytest.approx(sum(ends) / 2)


FIXED = {
    "object_mass": (0.15, {"mass", "mass_scale"}),
    "object_size": ((0.4, 0.02, 0.26), {"size_scale"}),
    "com_offset": ((0.0, 0.0), {"com_x", "com_z"}),
    "r": (0.002, {"radius_scale"}),
    "mu_c": (0.31, {"mu_c", "mu_s"}),
    "mu_s": (0.9, {"mu_c", "mu_s"}),
    "material": ("wood", {"mu_c", "mu_s"}),
    "initial_force": (16.0, set()),
}


@pytest.mark.parametrize("option", FIXED)
def test_options_win_and_shift_no_other_draw(make, env_id, option):
    env = make(env_id, randomization="eval_ood")
    value, concerned = FIXED[option]
    free = env.reset(seed=1)[1]["drawn"]
    _, info = env.reset(seed=1, options={option: value})
    kept = {name: value for name, value in info["drawn"].items() if name not in concerned}
    assert kept == {name: value for name, value in free.items() if name not in concerned}
    if option in ("mu_c", "mu_s"):
        assert info["drawn"][option] == value
        assert info["true"][0] / info["true"][1] == pytest.approx(free["mu_s"] / free["mu_c"])
    if option == "object_mass":
        assert info["drawn"]["mass"] == value


def test_draws_spread_over_the_ranges(make, hanging_id):
    env = make(hanging_id, randomization="train")
    ranges = env.randomization.of(env.task.key)
    drawn = [env.reset(seed=seed)[1]["drawn"] for seed in range(60)]
    for name in ("mu_c", "lag", "slip_latency", "bias_scale", "radius_scale", "com_z"):
        low, high = getattr(ranges, name).ends
        values = np.array([draw[name] for draw in drawn])
        assert low <= values.min() < low + 0.2 * (high - low)
        assert high - 0.2 * (high - low) < values.max() <= high


def test_unknown_materials_and_pads_without_room_are_refused(make):
    with pytest.raises(ValueError, match=r"randomization: unknown material 'glass'.*wood"):
        make(randomization={"materials": ["glass"]})
    with pytest.raises(ValueError, match=r"largest radius r = 0\.02 m must not exceed"):
        make(randomization={"radius_scale": at(2.0)})
    with pytest.raises(ValueError, match=r"largest radius r = 0\.012 m needs a uniform patch"):
        make(randomization={"radius_scale": at(1.2)}, contact="distributed")


def test_materials_are_drawn_from_the_list(make):
    env = make(randomization={"materials": ["wood", "case"]})
    drawn = {env.reset(seed=seed)[1]["true"][1] for seed in range(30)}
    assert drawn == {env.config.materials[name].mu_c for name in ("wood", "case")}


def test_a_patch_has_the_drawn_pressure(make):
    env = make(
        randomization={"pressure": ["hertz", "rim"]}, contact="distributed", config={"contact": {"cells": 7}}
    )
    seen = {}
    for seed in range(4):
        _, info = env.reset(seed=seed)
        seen[info["drawn"]["pressure"]] = info["true"][2]
        cells = env.simulation.plant.cells[0, 0]
        assert cells[LOAD].sum() == pytest.approx(1.0)
        assert cells[LOAD] @ np.hypot(cells[X], cells[Y]) == pytest.approx(1.0)
    assert seen == {name: pytest.approx(0.015 / OUTER_RADII[name]) for name in ("hertz", "rim")}


@pytest.mark.parametrize("estimator", ["rls", "joint"])
def test_an_estimator_is_told_the_latency_of_the_preset_only(make, estimator):
    env = make(randomization={"slip_latency": at(3)}, estimator=estimator)
    env.reset(seed=0)
    assert (env.simulation.plant.slip_sensors["delay"] == 3).all()
    parameters = env.simulation.estimator.parameters_array
    assert ("velocity_delay" in parameters.dtype.names) == (estimator == "joint")
    if estimator == "joint":
        assert parameters["velocity_delay"] == env.config.sensors.slip.latency_samples == 1
        twin = pickle.loads(pickle.dumps(env))
        twin.reset(seed=1, options={"randomization_scale": 0.0})
        assert twin.simulation.estimator.parameters_array["velocity_delay"] == 1
        twin.close()
        env = make(randomization={"slip_latency": at(3)}, estimator={"name": "joint", "velocity_delay": 2})
        env.reset(seed=0)
        assert env.simulation.estimator.parameters_array["velocity_delay"] == 2


def test_biases_spread_as_drawn(make):
    env = make(randomization={"bias_scale": at(2.0)})
    biases = []
    for seed in range(100):
        env.reset(seed=seed)
        biases.append(env.simulation.plant.force_torque["bias"].copy())
    spread = np.reshape(biases, (-1, 6)).std(axis=0)
    np.testing.assert_allclose(spread, 2.0 * env.simulation.plant.force_torque["noise"][0, 0], rtol=0.25)


def test_friction_drifts_and_jumps(make, env_id):
    values = {"friction_drift": at(-0.1), **sure("friction_jump", time=0.5, factor=1.5)}
    env = make(env_id, randomization=values, friction_source="true")
    _, info = env.reset(seed=0)
    start = info["true"]
    for k in range(90):
        observation, *_, info = env.step(FIRM)
        factor = math.exp(-0.1 * k / 120) * (1.5 if k >= 60 else 1.0)
        np.testing.assert_allclose(info["true"][:2], factor * start[:2], rtol=1e-12)
        np.testing.assert_allclose(observation[-6:-3], info["true"], rtol=1e-6)
    assert info["true"][2] == start[2]


def test_a_patch_of_other_friction_lies_where_it_was_drawn(make):
    env = make(randomization=sure("surface_region", start=0.005, length=0.01, factor=1.2), material="wood")
    _, info = env.reset(seed=0, options={"object_mass": 0.4})
    start, inside, slip = info["true"][0], [], np.zeros(3)
    while np.hypot(*slip[:2]) < 0.03:
        before = slip
        *_, info = env.step(np.float32([-0.75]))
        slip = info["slip"]
        on = 0.005 <= np.hypot(*before[:2]) < 0.015
        assert info["true"][0] == pytest.approx(start * (1.2 if on else 1.0))
        inside.append(bool(on))
    assert {True, False} == set(inside)


def test_a_heavier_object_is_carried_and_weighs_so_in_the_engine(make, hanging_id):
    values = sure("mass_change", time=0.5, factor=1.5)
    env = make(hanging_id, randomization=values, sensors="ideal")
    quiet = {} if "Hold" not in hanging_id else {"shake_amplitude": 0.0, "shake_pitch": 0.0}
    env.reset(seed=0, options={"object_mass": 0.1, "initial_force": 20.0, **quiet})
    loads, masses = [], []
    for _ in range(85):
        observation, *_ = env.step(np.float32([0.8]))
        loads.append(np.hypot(*(observation[[0, 1]] + observation[[7, 8]])))
        world = env.simulation.world
        masses.append(pybullet.getDynamicsInfo(world.body, -1, world.client)[0])
    assert masses == [0.1] * 60 + [pytest.approx(0.15)] * 25
    if "Hinge" not in hanging_id:
        assert loads[55] == pytest.approx(0.981, rel=0.02)
        assert loads[-1] == pytest.approx(1.5 * 0.981, rel=0.02)
    env.reset(seed=0, options={"object_mass": 0.1})
    assert pybullet.getDynamicsInfo(env.simulation.world.body, -1, env.simulation.world.client)[0] == 0.1


def test_a_push_carries_its_impulse_in_its_direction(make, hanging_id):
    values = sure("push", time=0.2, duration=0.05, impulse=0.01, direction=math.pi / 2, lever=0.02)
    env = make(hanging_id, randomization=values)
    env.reset(seed=0, options={"poke_impulse": (0.0, 0.0)} if "Hold" in hanging_id else None)
    impulse = np.zeros(3)
    for _ in range(60):
        env.step(FIRM)
        impulse += env.simulation.plant.world["external"][0] / 120
    np.testing.assert_allclose(impulse, [0.0, 0.01, 0.0002], atol=1e-12)


def test_a_drawn_shake_moves_the_wrist_as_far_as_it_says(make, hanging_id):
    env = make(hanging_id, randomization=sure("shake", amplitude=0.002, pitch=0.01, frequency=2.0))
    quiet = {"shake_amplitude": 0.0, "shake_pitch": 0.0} if "Hold" in hanging_id else {}
    env.reset(seed=0, options=quiet | ({"turn": 0.01} if "Hinge" in hanging_id else {}))
    wrist = []
    for _ in range(300):
        env.step(np.float32([0.5]))
        wrist.append(env.simulation.plant.world["wrist"][0].copy())
    swing = np.ptp(wrist[60:], axis=0)
    np.testing.assert_allclose(swing[:2], 0.004, rtol=0.05)
    assert swing[2] == pytest.approx(0.02, rel=0.05 if "Hinge" not in hanging_id else 0.6)
    if "Hinge" in hanging_id:  # a drawn shake is not the agent straying from the script
        assert env.simulation.episode["own"][0, 0] == pytest.approx(wrist[-1][2], abs=1e-3)


@pytest.mark.quick_cases("slipgym/LinearSlip-v0")
def test_a_state_goes_on_through_what_happens(make, env_id, play):
    env, other = (make(env_id, randomization="eval_ood", estimator="joint") for _ in range(2))
    actions = np.random.default_rng(0).uniform(-0.5, 1.0, (200, 1))
    for seed in range(3):
        env.reset(seed=seed)
        for action in actions[: 40 + 50 * seed]:
            env.step(action)
        state = pickle.loads(pickle.dumps(env.get_state()))
        said = [repr(env.step(action)) for action in actions]
        other.set_state(state)
        assert [repr(other.step(action)) for action in actions] == said
        assert repr(other.reset()) == repr(env.reset())


def test_spec_survives_json(env_id):
    env = gym.make(env_id, randomization=sure("mass_change", time=0.5, factor=1.5))
    again = gym.make(gym.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    assert again.unwrapped.randomization == env.unwrapped.randomization
    env.close()
    again.close()


@pytest.mark.parametrize("engine", ["bullet", "planar"])
def test_a_pressure_of_fewer_cells_than_another(make, engine):
    """Its patch has cells without share, in the room of the other's."""
    arguments = {"contact": "distributed", "engine": engine, "sensors": "ideal"}
    drawn = make(randomization={"pressure": ["rim"]}, config={"contact": {"cells": 7}}, **arguments)
    fixed = make(config={"contact": {"cells": 7, "pressure": "rim"}}, **arguments)
    rooms = [env.simulation.plant.cells.shape[-1] for env in (drawn, fixed)]
    assert rooms[0] > rooms[1]
    for k in range(2):
        (first, _), (other, _) = (env.reset(seed=k, options={"material": "wood"}) for env in (drawn, fixed))
        np.testing.assert_allclose(first, other, rtol=1e-5, atol=1e-6)
        for _ in range(30):
            observation, *_ = drawn.step(np.float32([-0.8]))
            expected, *_ = fixed.step(np.float32([-0.8]))
            np.testing.assert_allclose(observation, expected, rtol=1e-5, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("contact", ["ellipsoid", "distributed"])
def test_random_actions_under_eval_ood(make, env_id, contact):
    """25 000 steps for each task, 100 000 in all (distributed: a twelfth): finite, within the bounds."""
    env = make(env_id, randomization="eval_ood", contact=contact, action_mode="grip_force_wrist")
    rng = np.random.default_rng(0)
    observation, _ = env.reset(seed=0)
    for k in range(25_000 if contact == "ellipsoid" else 2_000):
        if k % 12 == 0:
            action = rng.uniform(-1.0, 1.0, 4)
        observation, reward, terminated, truncated, _ = env.step(action)
        assert env.observation_space.contains(observation)
        assert math.isfinite(reward)
        if terminated or truncated:
            observation, _ = env.reset()
            assert env.observation_space.contains(observation)
