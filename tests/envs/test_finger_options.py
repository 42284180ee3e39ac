"""Fingers that differ in an environment: options, randomization, what is reported of them."""

import re

import gymnasium as gym
import numpy as np
import pytest

from slipgym.envs.values import DIFFERENCES

LINEAR = "slipgym/LinearSlip-v0"
FIRM = np.float32([0.2])
WOOD = {"material": "wood"}
UNLIKE = {
    "finger_friction": (0.9, 1.2),
    "finger_radius": (0.8, 1.1),
    "cop_offset": ((0.001, -0.002), (0.0, 0.003)),
    "finger_lag": (0.5, 1.5),
    "force_gain": (0.9, 1.2),
}
WRONG = [
    ("finger_friction", (0.0, 1.0), "option finger_friction = 0.0: Input should be greater"),
    ("finger_friction", (1.0,), "option finger_friction = (1.0,): Field required"),
    ("finger_lag", 1.0, "option finger_lag = 1.0: Input should be a valid tuple"),
    ("force_gain", (1.0, 20.0), "option force_gain = 20.0: Input should be less than or equal to 10"),
    ("finger_radius", (1.0, 1.6), "option finger_radius: the larger radius r must not exceed"),
    ("cop_offset", ((0.0, 0.0), (0.012, 0.012)), "(0.012, 0.012) m of finger 2 must lie on the pad"),
    ("cop_offset", (0.0, 0.0), "option cop_offset = 0.0: Input should be a valid tuple"),
]  # fmt: skip


def values(env) -> dict:
    """What each finger of the first environment has."""
    plant = env.simulation.plant
    pads, fingers = plant.pads[0], plant.fingers[0]
    return {
        "friction": np.array([pads["mu_s"], pads["mu_c"]]).T.tolist(),
        "r": pads["r"].tolist(),
        "cop": pads["cop"].tolist(),
        "lag": fingers["lag"].tolist(),
        "gain": fingers["gain"].tolist(),
    }


@pytest.mark.parametrize("engine", ["bullet", "planar"])
def test_options_set_each_finger_and_only_for_one_episode(make, engine):
    env = make(LINEAR, engine=engine)
    _, info = env.reset(seed=0, options={**UNLIKE, **WOOD})
    wood = env.config.materials["wood"]
    expected = [[factor * wood.mu_s, factor * wood.mu_c] for factor in UNLIKE["finger_friction"]]
    now = values(env)
    np.testing.assert_allclose(now["friction"], expected)
    np.testing.assert_allclose(now["r"], [0.008, 0.011])
    np.testing.assert_array_equal(now["cop"], UNLIKE["cop_offset"])
    np.testing.assert_allclose(now["lag"], [0.006, 0.018])
    assert now["gain"] == [0.9, 1.2]
    np.testing.assert_allclose(info["true_per_finger"], np.column_stack([expected, [0.008, 0.011]]))
    np.testing.assert_allclose(info["true"], info["true_per_finger"].mean(axis=0))
    np.testing.assert_allclose(info["grip_force"], env.settings.initial_force * np.array([0.9, 1.2]))
    np.testing.assert_allclose(
        env.simulation.plant.pads["normal"], 1.05 * env.settings.initial_force, rtol=1e-4
    )
    env.reset(seed=0, options=WOOD)
    assert values(env) == {
        "friction": [[wood.mu_s, wood.mu_c]] * 2,
        "r": [0.01, 0.01],
        "cop": [[0.0, 0.0]] * 2,
        "lag": [0.012, 0.012],
        "gain": [1.0, 1.0],
    }


def test_the_configuration_says_the_same(make):
    names = {name: own.group for name, own in DIFFERENCES.items()}
    config = {group: {n: UNLIKE[n] for n in names if names[n] == group} for group in set(names.values())}
    configured, asked = make(LINEAR, config=config), make(LINEAR)
    first = configured.reset(seed=4), [configured.step(FIRM) for _ in range(30)]
    other = asked.reset(seed=4, options=UNLIKE), [asked.step(FIRM) for _ in range(30)]
    assert repr(first) == repr(other)


@pytest.mark.parametrize(("name", "value", "message"), WRONG)
def test_wrong_options_are_named(make, name, value, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        make(LINEAR).reset(seed=0, options={name: value})


def test_a_patch_that_covers_its_pad_cannot_be_larger_on_a_finger(make):
    config = {"contact": {"cells": 5}}
    env = make(LINEAR, contact="distributed", config=config)
    with pytest.raises(
        ValueError, match=r"option finger_radius: the larger radius r = 0\.011 m needs a unif"
    ):
        env.reset(seed=0, options={"finger_radius": (1.0, 1.1)})
    env.reset(seed=0, options={"finger_radius": (0.5, 1.0)})
    with pytest.raises(ValueError, match=r"randomization: the largest radius r = 0\.012 m needs a uniform"):
        make(LINEAR, contact="distributed", randomization={"finger_radius": {"uniform": [0.9, 1.2]}})
    with pytest.raises(ValueError, match=r"contact\.finger_radius: the larger radius r = 0\.011 m needs a"):
        make(LINEAR, contact="distributed", config={"contact": {"finger_radius": [1.1, 1.0]}})


def test_a_centre_of_pressure_must_lie_on_the_pad(make):
    with pytest.raises(ValueError, match=r"randomization\.cop_offset: the farthest: .* must lie on the pad"):
        make(LINEAR, randomization={"cop_offset": {"uniform": [-0.012, 0.0]}})
    with pytest.raises(
        ValueError, match=r"contact\.cop_offset: \(0\.02, 0\) m of finger 1 must lie on the pad"
    ):
        make(LINEAR, config={"contact": {"cop_offset": [[0.02, 0.0], [0.0, 0.0]]}})


@pytest.mark.quick_cases(
    "slipgym/LinearSlip-v0-train", "slipgym/Hold-v0-eval_ood", "slipgym/PlanarSlip-v0-train"
)
@pytest.mark.parametrize("preset", ["train", "eval_ood"])
def test_presets_draw_each_finger_on_its_own(make, env_id, preset):
    env = make(env_id, randomization=preset)
    ranges = env.randomization.of(env.task.key)
    seen = {}
    for seed in range(40):
        _, info = env.reset(seed=seed)
        drawn = info["drawn"]
        for name, own in DIFFERENCES.items():
            numbers = [drawn[f"{name}_{part}"] for part in own.parts]
            assert len(set(numbers)) == len(numbers)
            seen.setdefault(name, []).append(numbers)
        now = values(env)
        assert now["gain"] == [drawn["force_gain_1"], drawn["force_gain_2"]]
        assert now["lag"] == [drawn[f"finger_lag_{f}"] * drawn["lag"] for f in (1, 2)]
        assert now["cop"] == [[drawn[f"cop_offset_{a}_{f}"] for a in "xy"] for f in (1, 2)]
        assert info["true_per_finger"][:, 1].tolist() == [
            drawn[f"finger_friction_{f}"] * drawn["mu_c"] for f in (1, 2)
        ]
    for name, rows in seen.items():
        low, high = getattr(ranges, name).ends
        columns = np.array(rows).T
        assert (columns.min(axis=1) < low + 0.2 * (high - low)).all()
        assert (columns.max(axis=1) > high - 0.2 * (high - low)).all()
        assert ((columns >= low) & (columns <= high)).all()
        far = np.corrcoef(columns) - np.eye(len(columns))
        assert np.abs(far).max() < 0.55  # 40 episodes


def test_an_option_fixes_a_difference_and_shifts_no_draw(make):
    env = make(LINEAR, randomization="eval_ood")
    free = env.reset(seed=1)[1]["drawn"]
    for name, own in DIFFERENCES.items():
        _, info = env.reset(seed=1, options={name: UNLIKE[name] if name != "finger_radius" else (0.8, 0.9)})
        gone = {f"{name}_{part}" for part in own.parts}
        assert info["drawn"] == {key: value for key, value in free.items() if key not in gone}


def test_scale_leads_back_to_equal_fingers(make):
    env, plain = make(LINEAR, randomization="eval_ood"), make(LINEAR)
    plain.reset(seed=0)
    ends = [
        env.reset(seed=3, options={"randomization_scale": scale})[1]["drawn"] for scale in (0.0, 0.5, 1.0)
    ]
    for name, own in DIFFERENCES.items():
        for part in own.parts:
            none, half, whole = (drawn[f"{name}_{part}"] for drawn in ends)
            assert none == (0.0 if name == "cop_offset" else 1.0)
            assert half == pytest.approx(0.5 * (none + whole))
    env.reset(seed=3, options={"randomization_scale": 0.0})
    now, same = values(env), values(plain)
    assert {key: now[key] for key in ("r", "cop", "lag", "gain")} == {
        key: same[key] for key in ("r", "cop", "lag", "gain")
    }


@pytest.mark.parametrize("engine", ["bullet", "planar"])
def test_the_truth_of_each_finger_is_that_under_its_load(make, engine):
    pad = {"pad": {"load_exponent": 0.3, "radius_exponent": 0.1}}
    env = make(LINEAR, engine=engine, material="wood", config={"contact": pad})
    _, info = env.reset(seed=0, options={"finger_friction": (0.9, 1.2)})
    start = info["true_per_finger"]
    for _ in range(40):
        *_, info = env.step(FIRM)
        np.testing.assert_allclose(info["true"], info["true_per_finger"].mean(axis=0), rtol=1e-12)
    law = (info["grip_force"] / 5.0) ** -0.3  # of the last but one force, which hardly changes any more
    np.testing.assert_allclose(info["true_per_finger"][:, 1], start[:, 1] * law, rtol=2e-2)


@pytest.mark.parametrize("engine", ["bullet", "planar"])
def test_drift_and_jumps_keep_the_fingers_factors(make, engine):
    jump = {
        "kind": "friction_jump",
        "probability": 1,
        "time": {"choices": [0.2]},
        "factor": {"choices": [0.7]},
    }
    ranges = {"friction_drift": {"choices": [-0.1]}, "disturbances": [jump]}
    env = make(LINEAR, engine=engine, randomization=ranges, friction_source="true")
    options = {"finger_friction": (0.9, 1.2), "finger_radius": (0.8, 1.0)}
    _, info = env.reset(seed=0, options=options)
    start = info["true_per_finger"]
    for k in range(40):
        observation, *_, info = env.step(FIRM)
        factor = np.exp(-0.1 * k / 120) * (0.7 if k >= 24 else 1.0)
        np.testing.assert_allclose(info["true_per_finger"], start * [factor, factor, 1.0], rtol=1e-12)
        np.testing.assert_allclose(info["true"], info["true_per_finger"].mean(axis=0), rtol=1e-12)
        np.testing.assert_allclose(observation[-6:-3], info["true"], rtol=1e-6)


@pytest.mark.slow
def test_rows_with_fingers_of_their_own_equal_scalar_environments():
    rows = [UNLIKE, None, {"force_gain": (1.2, 0.8)}]
    arguments = {"randomization": "eval_ood", "config": {"contact": {"radius": 0.009}}}
    env = gym.make_vec(LINEAR, num_envs=3, **arguments)
    said = [env.reset(seed=5, options={"r": 0.008, "rows": rows})]
    actions = np.full((3, 1), -0.7, np.float32)
    said += [env.step(actions) for _ in range(80)]
    env.close()
    for i, row in enumerate(rows):
        one = gym.make(LINEAR, engine="planar", **arguments).unwrapped
        observation, info = one.reset(seed=5 + i, options={"r": 0.008, **(row or {})})
        np.testing.assert_array_equal(said[0][0][i], observation)
        for step in said[1:]:
            observation, reward, *_, info = one.step(actions[0])
            np.testing.assert_array_equal(step[0][i], observation)
            assert step[1][i] == reward
            for name in ("true", "true_per_finger", "grip_force", "slip"):
                np.testing.assert_array_equal(step[-1][name][i], info[name])
        one.close()


def test_fingers_measure_their_own_centre_of_pressure(make):
    env = make(LINEAR, sensors="ideal", estimator="rls")
    env.reset(seed=0, options={"cop_offset": UNLIKE["cop_offset"], "com_offset": (0.0, 0.0)})
    observation, *_ = env.step(FIRM)
    wrench = env.simulation.plant.pads["wrench"][0]
    np.testing.assert_allclose(
        np.sort(np.abs(observation[[3, 10]])), np.sort(np.abs(wrench[:, 2])), rtol=1e-3, atol=1e-6
    )
