"""What is not known or not allowed is an error that names the value and what would have been right."""

import re

import numpy as np
import pytest

KEYWORDS = [
    ({"friction_source": "truth"}, "unknown friction_source 'truth'", "estimated, nominal, none, true"),
    ({"friction_source": None}, "unknown friction_source None", "estimated, nominal, none, true"),
    ({"estimator": "ekf"}, "unknown estimator 'ekf'", "rls"),
    ({"estimator": 3}, "estimator = 3", "rls"),
    ({"estimator": {"forgetting": 0.9}}, "estimator = {'forgetting': 0.9}", "rls"),
    ({"estimator": {"name": "rls", "lambda_": 1}}, "unknown parameter lambda_", "forgetting"),
    ({"estimator": {"name": "rls", "forgetting": 2.0}}, "forgetting = 2.0", "1"),
    ({"contact": "point"}, "unknown contact 'point'", "ellipsoid"),
    ({"sensors": "perfect"}, "unknown sensors 'perfect'", "ideal, lab, markers, motor, realistic, wrist"),
    ({"sensors": 3}, "unknown sensors 3", "ideal, lab, markers, motor, realistic, wrist"),
    ({"material": "glass"}, "unknown material 'glass'", "cardboard, case, plastic, random, wood"),
    (
        {"action_mode": "torque"},
        "unknown action_mode 'torque'",
        "force_increment, grip_force, grip_force_pitch",
    ),
    ({"observation_mode": "image"}, "unknown observation_mode 'image'", "dict, flat, sensor"),
    ({"history": -1}, "history = -1", ">= 0"),
    ({"history": 0.5}, "history = 0.5", "whole number"),
    ({"randomization": "wild"}, "unknown randomization 'wild'", "none"),
    ({"frame_skip": 0}, "frame_skip = 0", ">= 1"),
    ({"frame_skip": 1.5}, "frame_skip = 1.5", "whole number"),
    ({"frame_skip": True}, "frame_skip = True", "whole number"),
    ({"end_at_violation": 1}, "end_at_violation = 1", "True or False"),
    ({"load_columns": "yes"}, "load_columns = 'yes'", "True or False"),
    ({"render_mode": "ascii"}, "unknown render_mode 'ascii'", "rgb_array"),
    ({"config": {"objekt": {}}}, "unknown key 'objekt'", "did you mean 'object'"),
    ({"config": {"object": {"mas": 1.0}}}, "object.mas: unknown key 'mas'", "did you mean 'mass'"),
    ({"config": {"object": {"mass": -1.0}}}, "object.mass = -1.0", ">= 0.001"),
    ({"config": 3}, "config argument", "mapping or a path, got 3"),
]


@pytest.mark.parametrize(("keyword", "what", "valid"), KEYWORDS, ids=[str(row[0]) for row in KEYWORDS])
def test_a_wrong_keyword_argument(make, env_id, keyword, what, valid):
    cls = type(make(env_id))
    with pytest.raises(ValueError, match=re.escape(what)) as caught:
        cls(**keyword)
    assert valid in str(caught.value)


def test_an_unknown_keyword(make, env_id):
    with pytest.raises(TypeError, match=r"unknown keyword argument 'frictionsource'.*friction_source"):
        make(env_id, frictionsource="true")


def test_a_missing_config_file(make, env_id):
    with pytest.raises(FileNotFoundError, match=r"absent\.yaml"):
        make(env_id, config="absent.yaml")


OPTIONS = [
    ({"masss": 1.0}, "unknown option 'masss'", "object_mass"),
    ({1: 2}, "unknown option '1'", "object_mass"),
    ({"material": "glass"}, "unknown material 'glass'", "cardboard, case, plastic, random, wood"),
    ({"mu_s": -1.0}, "mu_s = -1.0", "greater than 0"),
    ({"mu_s": 0.2, "mu_c": 0.3}, "mu_s = 0.2", "at least mu_c = 0.3"),
    ({"object_mass": float("nan")}, "object_mass = nan", "finite"),
    ({"object_mass": "heavy"}, "object_mass = 'heavy'", "number"),
    ({"initial_force": 100.0}, "initial_force = 100.0", "40"),
    ({"duration": 0.0}, "duration = 0.0", "greater than 0"),
    ({"com_offset": (0.5, 0.0)}, "com_offset (0.5, 0.0)", "must lie on the object"),
    ({"object_size": (0.02, 0.02, 0.1)}, "grasp_offset", "0.02 m by 0.1 m"),
    ([("mu_s", 1.0)], "options = [('mu_s', 1.0)]", "must be a mapping"),
]


@pytest.mark.parametrize(("options", "what", "valid"), OPTIONS, ids=[str(row[0]) for row in OPTIONS])
def test_a_wrong_reset_option(make, env_id, options, what, valid):
    with pytest.raises(ValueError, match=re.escape(what)) as caught:
        make(env_id).reset(seed=0, options=options)
    assert valid in str(caught.value)


def test_a_refused_reset_does_no_harm(make, env_id, play):
    env = make(env_id)
    with pytest.raises(ValueError, match="mu_s"):
        env.reset(seed=1, options={"mu_s": -1.0})
    assert play(env) == play(make(env_id))


ACTIONS = [
    ([np.nan], "nan"),
    ([np.inf], "inf"),
    ([-np.inf], "inf"),
    (0.5, "shape (1,)"),
    ([0.0, 0.0], "shape (1,)"),
    ([[0.0]], "shape (1,)"),
    ([], "shape (1,)"),
    (None, "array of numbers"),
    (["strong"], "strong"),
    ([1j], "1j"),
    ({"force": 1}, "force"),
]


@pytest.mark.parametrize(("action", "what"), ACTIONS, ids=[str(row[0]) for row in ACTIONS])
def test_a_wrong_action_is_refused_and_moves_nothing(make, action, what):
    env, twin = make(), make()
    env.reset(seed=0)
    twin.reset(seed=0)
    with pytest.raises(ValueError, match=re.escape(what)) as caught:
        env.step(action)
    assert "action" in str(caught.value)
    assert repr(env.step([0.1])) == repr(twin.step([0.1]))


@pytest.mark.parametrize("dtype", [np.float64, np.float16, np.int64, bool])
def test_any_number_type_will_do(make, dtype):
    env, twin = make(), make()
    env.reset(seed=0)
    twin.reset(seed=0)
    assert repr(env.step(np.ones(1, dtype))) == repr(twin.step(np.ones(1, np.float32)))


def test_actions_outside_the_space_act_like_its_ends(make):
    env, twin = make(), make()
    env.reset(seed=0)
    twin.reset(seed=0)
    for outside, end in ((3.0, 1.0), (-3.0, -1.0)):
        assert repr(env.step([outside])) == repr(twin.step([end]))


def test_config_by_file_and_by_mapping_agree(make, env_id, tmp_path, play):
    """And a task without an object and a radius of its own takes the common ones."""
    path, key = tmp_path / "mine.yaml", make(env_id).task.key
    path.write_text(
        "object: {mass: 0.35}\ncontact: {radius: 0.008}\nmaterials: {glass: {mu_c: 0.2, mu_s: 0.25}}\n"
        f"tasks: {{{key}: {{object: null, radius: null, radius_range: null}}}}\n"
    )
    mapping = {
        "tasks": {key: {"object": None, "radius": None, "radius_range": None}},
        "object": {"mass": 0.35},
        "contact": {"radius": 0.008},
        "materials": {"glass": {"mu_c": 0.2, "mu_s": 0.25}},
    }
    by_file = make(env_id, config=path, material="glass")
    by_mapping = make(env_id, config=mapping, material="glass")
    assert play(by_file) == play(by_mapping) != play(make(env_id))
    assert by_file.reset(seed=0)[1]["true"].tolist() == [0.25, 0.2, 0.008]


@pytest.mark.parametrize("material", ["cardboard", "case", "plastic", "wood"])
def test_a_material_fixes_the_true_friction(make, material):
    env = make(material=material)
    expected = env.config.materials[material]
    for seed in range(3):
        assert env.reset(seed=seed)[1]["true"].tolist() == [expected.mu_s, expected.mu_c, 0.01]


def test_random_draws_every_material(make, hanging_id):
    env = make(hanging_id)
    drawn = {env.reset(seed=seed)[1]["true"][1] for seed in range(40)}
    assert drawn == {material.mu_c for material in env.config.materials.values()}


def test_sensor_presets_differ_in_noise_only(make):
    heard = {}
    for preset in ("ideal", "realistic"):
        env = make(sensors=preset, material="wood", config={"physics": {"gravity": 0.0}})
        env.reset(seed=0)
        force = np.float32([-0.2])
        heard[preset] = np.array([env.step(force)[0][:14] for _ in range(100)])
    assert np.ptp(heard["ideal"][60:], axis=0).max() < 1e-6
    assert heard["realistic"][60:, :2].std() == pytest.approx(0.02, rel=0.3)
    assert heard["realistic"].mean(axis=0)[2] == pytest.approx(heard["ideal"].mean(axis=0)[2], abs=0.05)
