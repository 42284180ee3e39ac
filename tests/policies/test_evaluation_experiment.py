import pytest
import yaml

import policies
from policies.evaluation import experiment_names, load_experiment, narrowed
from policies.evaluation.plan import plan


def test_the_experiments_that_come_with_slipgym_load():
    assert {"demo", "hold", "linear_slip"} <= set(experiment_names())
    for name in experiment_names():
        experiment = load_experiment(name)
        assert experiment.name == name
        for chosen in experiment.policies:  # an old name of a parameter would warn, which is an error here
            policies.load(chosen.name, **chosen.parameters)


def test_linear_slip_has_160_trials_for_each_friction_choice():
    experiment = load_experiment("linear_slip")
    assert len(plan(experiment)) == 160 * len(experiment.friction)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"task": "LinearSlop"}, r"task: unknown task 'LinearSlop'.*linear_slip"),
        ({"trials": 0}, r"trials = 0: .*1"),
        ({"materials": ["wod"]}, r"unknown material 'wod'.*wood"),
        ({"materials": []}, r"materials"),
        ({"policies": [{"name": "linear_slap"}]}, r"policies\.0: unknown policy.*linear_slip"),
        ({"policies": [{"name": "hold"}, {"name": "hold"}]}, r"distinct labels"),
        ({"friction": [{"source": "guessed"}]}, r"friction\.0: unknown friction source.*nominal"),
        ({"friction": [{"source": False}]}, r"friction\.0\.source = False: must be a text"),
        ({"friction": [{"source": "true", "estimator": {"name": "kf"}}]}, r"unknown estimator 'kf'.*rls"),
        ({"friction": [{"source": "true", "estimator": {"name": "rls", "p": 1}}]}, r"unknown parameter"),
        ({"friction": [{"source": "true", "lable": "x"}]}, r"unknown key 'lable'; did you mean 'label'"),
        ({"options": {"distanse": 0.1}}, r"unknown option 'distanse'.*distance"),
        ({"vary": {"duration": [-1.0]}}, r"duration = -1\.0"),
        ({"vary": {"material": ["wood"]}}, r"materials are listed"),
        ({"sensors": "perfect"}, r"unknown sensors 'perfect'.*ideal"),
        ({"config": {"object": {"mas": 1.0}}}, r"unknown key 'mas'.*mass"),
        ({"name": "../up"}, r"name = '\.\./up'"),
        ({"jobs": 2}, r"unknown key 'jobs'"),
    ],
)
def test_what_is_wrong_is_named_with_what_is_valid(small, change, message):
    with pytest.raises(ValueError, match=message):
        small(**change)


def test_an_estimator_may_be_a_name_and_is_named_in_tables(small):
    choices = small(friction=[{"source": "estimated"}, {"source": "estimated", "estimator": "rls"}]).friction
    assert [each.title for each in choices] == ["estimated", "estimated, rls"]
    assert choices[1].argument == {"name": "rls"}


@pytest.mark.parametrize(
    ("name", "remedy"),
    [
        ("nowhere:PI", "'nowhere' on Python's path; add its folder to PYTHONPATH"),
        ("nowhere.py:PI", "write nowhere:PI, and add its folder to PYTHONPATH"),
    ],
)
def test_a_module_that_is_not_found_is_named_with_the_remedy(small, name, remedy):
    with pytest.raises(ValueError, match=remedy):
        small(policies=[{"name": name}])


def test_unknown_experiments_and_missing_files(tmp_path):
    with pytest.raises(ValueError, match=r"'demmo'; did you mean 'demo'"):
        load_experiment("demmo")
    with pytest.raises(FileNotFoundError):
        load_experiment(tmp_path / "none.yaml")


def test_a_file_reads_like_its_values(small, tmp_path):
    experiment = small()
    path = tmp_path / "small.yaml"
    path.write_text(yaml.safe_dump(experiment.model_dump(mode="json")))
    assert load_experiment(path) == experiment


def test_narrowing(small):
    experiment = narrowed(small(), trials=5, seed=3, friction=["true"])
    assert (experiment.trials, experiment.seed) == (5, 3)
    assert [choice.source for choice in experiment.friction] == ["true"]
    with pytest.raises(ValueError, match=r"'nominal'.*estimated, true"):
        narrowed(small(), friction=["nominal"])
    with pytest.raises(ValueError, match=r"trials = 0"):
        narrowed(small(), trials=0)


def test_seeds_are_paired_and_distinct_otherwise(small):
    both = [{"name": "constant_force"}, {"name": "hold"}]
    trials = plan(small(policies=both))
    scenarios = {}
    for trial in trials:
        scenarios.setdefault((trial.material, trial.options["distance"], trial.number), set()).add(trial.seed)
    assert len(scenarios) == 8
    assert all(len(seeds) == 1 for seeds in scenarios.values())
    assert len(set().union(*scenarios.values())) == 8
    assert not set().union(*scenarios.values()) & {trial.seed for trial in plan(small(seed=1))}


def test_leaving_out_a_material_moves_no_seed(small):
    kept = {(t.keys["options"], t.number): t.seed for t in plan(small(materials=["case"]))}
    for trial in plan(small()):
        if trial.material == "case":
            assert trial.seed == kept[trial.keys["options"], trial.number]


def test_a_truth_value_of_yaml_is_the_true_friction(small):
    assert small(friction=[{"source": True}]).friction[0].source == "true"
