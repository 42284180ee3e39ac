"""Levels of difficulty: files, precedence, how they combine with a randomization, errors."""

import re

import gymnasium as gym
import numpy as np
import pytest
import yaml

from slipgym.config import load_randomization
from slipgym.config.level import DEFAULT, Level, level_names, load_level
from slipgym.tasks import TASKS, configure

LINEAR = "slipgym:slipgym/LinearSlip-v0"
OWN = {"settings": {"tolerance": 0.003, "hold": 0.5}, "randomization": {"mu_c": {"uniform": [0.3, 0.4]}}}


def make(**arguments):
    return gym.make(LINEAR, engine="planar", **arguments).unwrapped


@pytest.mark.parametrize("task", TASKS.values(), ids=list(TASKS))
def test_every_level_is_valid_and_easy_changes_nothing(task):
    names = level_names(task.key)
    assert names[0] == DEFAULT
    assert load_level(DEFAULT, task.key).level == Level()
    randomization = load_randomization("train")
    assert load_level(DEFAULT, task.key).level.applied_to(randomization, task.key) is randomization
    for name in names:
        chosen = load_level(name, task.key)
        assert chosen.argument == name
        assert configure(task, level=chosen)
        for preset in ("none", "train", "eval_ood"):
            chosen.level.applied_to(load_randomization(preset), task.key)
    levels = [load_level(name, task.key).level for name in names]
    assert all(a != b for k, a in enumerate(levels) for b in levels[:k])


def test_settings_replace_defaults_and_config_and_options_replace_them():
    assert make(level=OWN).settings.tolerance == 0.003
    env = make(level=OWN, config={"tasks": {"linear_slip": {"tolerance": 0.004}}})
    assert (env.settings.tolerance, env.settings.hold, env.settings.duration) == (0.004, 0.5, 5.0)
    env.reset(seed=0, options={"tolerance": 0.005})
    assert env.simulation.episode["tolerance"][0] == 0.005


def test_distributions_replace_those_of_the_randomization():
    ranges = make(level=OWN, randomization="train").randomization.of("linear_slip")
    train = load_randomization("train").of("linear_slip")
    assert ranges.mu_c.ends == (0.3, 0.4)
    assert ranges.friction_ratio == train.friction_ratio
    assert ranges.disturbances == train.disturbances
    jump = {
        "kind": "friction_jump",
        "probability": 1.0,
        "time": {"uniform": [1.0, 2.0]},
        "factor": {"uniform": [0.5, 0.6]},
    }
    level = Level.model_validate({"randomization": {"disturbances": [jump]}})
    kinds = [
        d.kind
        for d in level.applied_to(load_randomization("train"), "linear_slip").of("linear_slip").disturbances
    ]
    assert kinds == ["push", "shake", "friction_jump"]
    both = level.applied_to(load_randomization("eval_ood"), "linear_slip").of("linear_slip").disturbances
    (only,) = [each for each in both if each.kind == "friction_jump"]
    assert only.factor.ends == (0.5, 0.6)
    others = load_randomization("train")
    assert level.applied_to(others, "linear_slip").of("hold") == others.of("hold")


def test_an_environment_is_made_again_from_its_state_with_its_level(tmp_path):
    path = tmp_path / "own.yaml"
    path.write_text(yaml.safe_dump(OWN))
    jump = level_names("linear_slip")[-1]
    for level in (jump, OWN, path):
        env = make(level=level, randomization="train")
        env.reset(seed=3)
        other = make(**{k: v for k, v in env._arguments.items() if k != "engine"})
        assert other.randomization == env.randomization
        other.set_state(env.get_state())
        action = np.float32([-0.9])
        assert env.step(action)[1] == other.step(action)[1]


def test_a_row_of_a_batch_is_the_environment():
    envs = gym.make_vec(LINEAR, 3, "vector_entry_point", level="hard")
    env = make(level="hard")
    observations, infos = envs.reset(seed=5)
    observation, info = env.reset(seed=6)
    np.testing.assert_array_equal(observations[1], observation)
    np.testing.assert_array_equal(infos["true"][1], info["true"])
    envs.close()


@pytest.mark.parametrize(
    ("level", "said"),
    [
        ("hrd", "unknown level of linear_slip 'hrd'; did you mean 'hard'? valid: easy, hard, standard"),
        ({"setting": {}}, "level argument: setting: unknown key 'setting'; did you mean 'settings'"),
        ({"settings": {"toleranse": 1}}, "level argument: tasks.linear_slip.toleranse: unknown key"),
        ({"settings": {"tolerance": -1}}, "tasks.linear_slip.tolerance = -1: must be a finite number > 0"),
        ({"randomization": {"mu": 1}}, "level argument: randomization.mu: unknown key 'mu'"),
        (3, "level = 3 must be a name, a path or a mapping; names: easy, standard, hard"),
    ],
)
def test_what_is_wrong_is_named(level, said):
    with pytest.raises(ValueError, match=re.escape(said)):
        make(level=level)


def test_a_missing_file_is_named():
    with pytest.raises(FileNotFoundError, match="nothing"):
        make(level="nothing.yaml")


def test_a_task_without_a_file_has_the_default_alone():
    assert level_names("no_such_task") == [DEFAULT]
