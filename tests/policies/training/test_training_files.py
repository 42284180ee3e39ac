from datetime import datetime
from types import SimpleNamespace

import pytest
import yaml

from policies.learned import pretrained, read_description
from policies.training import files, seeds
from policies.training.config import Training
from slipgym.tasks import TASKS


@pytest.mark.parametrize("name", files.names())
def test_every_configuration_loads_and_is_written_as_it_was_read(name):
    training = files.load(name)
    assert files.chosen(None, {"task": training.task}, []).task == training.task
    assert files.checked(yaml.safe_load(files.text(training)), name) == training


@pytest.mark.parametrize("task", TASKS.values(), ids=lambda task: task.key)
def test_a_tasks_name_stands_for_learning_it_from_nothing(task):
    own = files.load(f"{task.key}_scratch")
    for name in (task.key, task.name, task.id):
        assert files.load(name) == files.chosen(None, {"task": name}, []) == own
    with pytest.raises(ValueError, match=rf"configuration '{task.key}_nothing'.*carry_scratch"):
        files.load(f"{task.key}_nothing")


def test_every_sweep_tries_keys_that_exist():
    for name in files.names():
        training = files.load(name)
        for key, dimension in training.sweep.items():
            value = dimension.choices[0] if dimension.choices else dimension.low
            files.changed(training, {key: value})


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (
            ["ppo.gama=0.9"],
            r"ppo\.gama: unknown key 'gama'; did you mean 'gamma'\? valid: activation, .*vf_coef",
        ),
        (["gamma=0.9"], r"unknown key 'gamma'; valid: algorithm, budget"),
        (
            ["ppo.gamma=1.5"],
            r"ppo\.gamma = 1\.5: must be a number|ppo\.gamma = 1\.5: must be a finite number",
        ),
        (["environment.friction_source=guess"], r"friction_source = 'guess': must be one of 'estimated'"),
        (["environment.randomization=trian"], r"did you mean 'train'"),
        (["environment.material=wod"], r"did you mean 'wood'"),
        (["environment.action_mode=grip"], r"action_mode = 'grip': must be one of 'grip_force'"),
        (["task=Linear"], r"unknown task 'Linear'; valid: carry"),
        (["algorithm=pppo"], r"one of 'ppo', 'recurrent_ppo', 'sac', 'tqc'"),
        (["budget"], r"must be key=value"),
        (["budget={"], r"--set budget"),
        (["sweep={ppo.gamma: {low: 1}}"], r"either low and high or choices"),
        (["sweep={ppo.gamma: {low: 2, high: 1}}"], r"must not exceed"),
        (["vary={slide: 0.01}"], r"vary\.slide = 0\.01: must be a list of at least 1: each any value"),
        (["vary={slide: []}"], r"vary\.slide = \[\]: must be a list of at least 1"),
        (["shaping={tasks: {linear_slp: {}}}"], r"unknown task 'linear_slp'; did you mean 'linear_slip'"),
        (["privileged_ppo.curriculum.stages=[{tasks: {hold: {}}}]"], r"unknown task 'hold'"),
        (["shaping={tasks: 3}"], r"tasks = 3"),
        (["privileged_ppo.net_arch=[9000]"], r"net_arch.* = 9000"),
        (["environment.history=2000"], r"history = 2000"),
    ],
)
def test_what_is_wrong_is_named(texts, message):
    with pytest.raises(ValueError, match=message):
        files.chosen("linear_slip", {}, texts)


def test_a_wrong_file_is_named(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("task: LinearSlip\nbudget: 10\nalgoritm: ppo\n")
    with pytest.raises(ValueError, match=r"mine\.yaml: algoritm: unknown key .*did you mean 'algorithm'"):
        files.load(path)
    with pytest.raises(FileNotFoundError):
        files.load(tmp_path / "nowhere.yaml")
    with pytest.raises(ValueError, match="linear_slip"):
        files.chosen(None, {"task": None}, [])


def test_assignments_win_over_options_and_both_over_the_file():
    options = {"task": "LinearSlip", "budget": 1000, "algorithm": None}
    chosen = files.chosen(None, options, ["budget=2000", "ppo.learning_rate=1e-3", "ppo.net_arch=[8]"])
    assert (chosen.budget, chosen.ppo.learning_rate, chosen.ppo.net_arch) == (2000, 1e-3, (8,))
    assert chosen.ppo.n_steps == files.load("linear_slip_scratch").ppo.n_steps


def test_estimates_need_an_estimator(tmp_path):
    pytest.importorskip("stable_baselines3")
    from policies.training import run_set

    with pytest.raises(ValueError, match=r"--friction-source: .*'estimated' needs an estimator"):
        run_set.begun(files.load("carry"), [], ["true", "estimated"], 0, tmp_path, 1, "")
    assert not list(tmp_path.iterdir())
    wanted = ["environment.friction_source=estimated"]
    with pytest.raises(ValueError, match=r"environment\.estimator=adaptive runs one"):
        files.chosen("carry", {}, wanted)
    told = files.chosen("carry", {}, [*wanted, "environment.estimator=adaptive"])
    assert (told.environment.friction_source, told.environment.estimator) == ("estimated", "adaptive")


def test_no_training_seed_is_held_out():
    last = seeds.training(seeds.RUNS - 1) + seeds.ROWS - 1
    assert last == seeds.held_out(0) - 1
    assert seeds.training(1) - seeds.training(0) == seeds.ROWS
    assert Training.model_fields["num_envs"].metadata[1].le == seeds.ROWS
    for seed in (-1, seeds.RUNS):
        with pytest.raises(ValueError, match=rf"seed = {seed}"):
            seeds.training(seed)


def test_resuming_takes_no_other_option(tmp_path):
    pytest.importorskip("stable_baselines3")
    from policies.training import run_set

    with pytest.raises(ValueError, match="leave out --budget"):
        run_set.resumed(tmp_path, {"--seeds": None, "--budget": 3}, 1, "")
    with pytest.raises(FileNotFoundError, match="holds no training run"):
        run_set.resumed(tmp_path, {"--seeds": None}, 1, "")


def test_studies_begun_in_the_same_millisecond_have_folders_of_their_own(small, tmp_path, monkeypatch):
    from policies import versions
    from policies.training import run_set

    times = [datetime.fromtimestamp(0.001 * moment) for moment in (0, 0, 1)]
    monkeypatch.setattr(versions, "datetime", SimpleNamespace(now=iter(times).__next__))
    first, second = (run_set.lay_out([(small(), seed)], tmp_path) for seed in (0, 4))
    assert [run.name for run in first.iterdir()] == ["estimated__0"]
    assert [run.name for run in second.iterdir()] == ["estimated__4"]


def test_a_file_of_a_randomization_is_kept_as_its_content(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("noise_scale: {uniform: [0.5, 1.5]}\n")
    chosen = files.chosen("linear_slip", {}, [f"environment.randomization={path}"])
    assert chosen.environment.randomization == {"noise_scale": {"uniform": [0.5, 1.5]}}
    path.write_text("noise: 1\n")
    with pytest.raises(ValueError, match=r"mine\.yaml: .*unknown key 'noise'"):
        files.chosen("linear_slip", {}, [f"environment.randomization={path}"])


def test_a_truth_value_of_yaml_is_the_true_friction():
    chosen = files.chosen("linear_slip", {}, ["environment.friction_source=true"])
    assert chosen.environment.friction_source == "true"


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"environment.level": "harder"}, "unknown level of linear_slip 'harder'"),
        ({"environment.estimator": "foo"}, "'foo'"),
        ({"derived": {"error": {"slp": 1.0}}}, "derived: unknown column 'slp'"),
        ({"privileged_ppo.mirrored": ["slp"]}, r"privileged_ppo\.mirrored: unknown column 'slp'"),
        ({"privileged_ppo.start": "nowhere"}, "no learned policy at 'nowhere'"),
        ({"privileged_ppo.start": "hinge_lab"}, "is a policy for slipgym/Hinge-v0, not for LinearSlip"),
        ({"privileged_ppo.critic_first": 8}, r"critic_first = 8: .* add --set privileged_ppo\.start=FOLDER"),
    ],
)
def test_what_cannot_be_made_leaves_no_folder(tmp_path, changes, named):
    pytest.importorskip("stable_baselines3")
    from policies.training import run_set

    config = files.load("linear_slip", changes)
    with pytest.raises((ValueError, FileNotFoundError), match=named):
        run_set.begun(config, [], [], 0, tmp_path, 1, "")
    assert not list(tmp_path.iterdir())


def test_a_sweep_is_tried_before_there_is_a_folder_and_does_not_go_on(small, tmp_path):
    pytest.importorskip("optuna")
    from policies.training import run_set, sweep

    with pytest.raises(ValueError, match=r"ppo\.gama: unknown key 'gama'"):
        run_set.begun(small(sweep={"ppo.gama": {"low": 0.5, "high": 0.9}}), [], [], 2, tmp_path, 1, "")
    with pytest.raises(ValueError, match="no key sweep"):
        run_set.begun(small(), [], [], 2, tmp_path, 1, "")
    assert not list(tmp_path.iterdir())
    path = sweep.begin(small(sweep={"ppo.gamma": {"low": 0.5, "high": 0.9}}), tmp_path)
    with pytest.raises(ValueError, match="a sweep does not go on"):
        run_set.resumed(path, {}, 1, "")


@pytest.mark.parametrize(
    "name", [name for name in files.names() if files.load(name).privileged_ppo.start is not None]
)
def test_a_start_of_a_configuration_comes_with_slipgym_and_fits(name):
    pytest.importorskip("torch")
    from policies.training.policy_tensors import network

    training = files.load(name)
    start = read_description(pretrained.folders()[training.privileged_ppo.start])
    assert start.environment.id == f"slipgym/{training.task}-v0"
    assert start.network == network(training)
    for key in ("frame_skip", "action_mode", "load_columns"):
        assert start.environment.arguments[key] == getattr(training.environment, key)


def test_a_level_from_a_file_is_kept_as_its_content(tmp_path):
    path = tmp_path / "level.yaml"
    path.write_text("settings: {tolerance: 0.004}\n", encoding="utf-8")
    chosen = files.chosen("linear_slip", {}, [f"environment.level={path}"])
    assert chosen.environment.level == {"settings": {"tolerance": 0.004}}
