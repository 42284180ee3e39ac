from pathlib import Path

import numpy as np
import pytest

import policies
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.evaluation.plan import plan
from policies.study import load_study, narrowed, study_names
from policies.study.conditions import Change, conditions, missing, policies_of
from slipgym.config import load, load_randomization
from slipgym.envs.observation import columns
from slipgym.tasks import find


@pytest.fixture
def shelf(tmp_path, monkeypatch):
    monkeypatch.setattr("policies.evaluation.experiment.frame_skip_of", lambda name: 1)

    def make(*names):
        for name in names:
            (tmp_path / name).mkdir(parents=True)
            (tmp_path / name / "policy.json").write_text("{}")
        return str(tmp_path)

    return make


def test_the_studies_that_come_with_slipgym():
    assert study_names() == ["full", "hard", "hard_lab", "quick", "short"]
    full = load_study("full")
    assert (full.worlds[0].engine, full.worlds[0].contact) == ("bullet", "distributed")
    assert len(full.tasks) == 5
    assert full.blocks >= 3
    less = narrowed(full, episodes=2, tasks=["Hold"], seed=None)
    assert (less.episodes, less.tasks, less.videos, less.seed) == (2, ("Hold",), (), 0)
    assert less.degradation is not None
    assert less.degradation.episodes == 2


def test_a_memory_of_slips_acts_without_friction_information_alone(small, shelf):
    study = small(kinds=["classic", "memory"], sensors="lab")
    found = conditions(study, policies_of(study))
    (source,) = {condition.source for condition in found if condition.kind == "memory"}
    assert source == "none"
    experiment = found[-1].experiment(study)
    assert experiment.sensors == "lab"
    assert missing(study, policies_of(study)) == []
    made = [c.experiment(study).policies[0] for c in found if c.kind == "memory"]
    assert {choice.name for choice in made} == {"policies.controllers.slip_memory:SlipMemory"}
    assert {choice.label for choice in made} == {"memory"}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"tasks": ["Juggle"]}, "Juggle"),
        ({"presets": ["wet"]}, "wet"),
        ({"estimators": ["oracle"]}, "oracle"),
        ({"blocks": 0}, "blocks"),
        ({"tasks": ["Hold", "Hold"]}, "must differ"),
        ({"videos": ["Hinge"]}, "Hinge"),
        ({"degradation": {"world": "mars", "episodes": 1}}, "mars"),
        ({"colour": 1}, "colour"),
    ],
)
def test_refusals(small, changes, message):
    with pytest.raises(ValueError, match=message):
        small(**changes)


def test_learned_policies_by_task_source_and_seed(small, shelf):
    folder = shelf(
        "linear_slip_true_10", "linear_slip_true_2", "linear_slip_true", "linear_slip_none", "hold_true"
    )
    study = small(learned=folder)
    found = policies_of(study)
    assert {key: {seed: path.name for seed, path in paths.items()} for key, paths in found.items()} == {
        ("learned", "LinearSlip", "true"): {
            0: "linear_slip_true",
            2: "linear_slip_true_2",
            10: "linear_slip_true_10",
        },
        ("learned", "LinearSlip", "none"): {0: "linear_slip_none"},
    }
    (notice,) = missing(study, found)
    assert "no policy of kind learned for estimated;" in notice


@pytest.mark.parametrize(
    ("shipped", "sensors", "presets", "untold"),
    [
        (("memory", "lab", "lab_rigid"), "realistic", ["none"], "hold_memory"),
        (("memory", "lab"), "lab", ["none"], "hold_lab"),
        (("memory", "lab", "lab_rigid"), "lab", ["none", "train"], "hold_lab_rigid"),
        (("memory", "lab", "lab_rigid"), "lab", ["none", "lab"], "hold_lab"),
    ],
)
def test_learned_policies_that_come_with_slipgym(small, shelf, shipped, sensors, presets, untold):
    folder = shelf("linear_slip_scratch", "hold_scratch", *(f"hold_{ending}" for ending in shipped))
    study = small(tasks=["Hold"], learned=folder, sensors=sensors, presets=presets, degradation=None)
    assert {key[2]: [path.name for path in paths.values()] for key, paths in policies_of(study).items()} == {
        "true": ["hold_scratch"],
        "none": [untold],
    }


def test_the_kind_recurrent_is_the_policy_for_the_sensors_and_pads(small):
    changes = {"kinds": ["recurrent"], "sensors": "lab", "presets": ["none"], "degradation": None}
    study = small(tasks=["Hold"], config={}, **changes)
    assert {Path(one.policy).name for one in conditions(study, {})} == {"hold_lab_rigid"}


def test_a_policy_that_comes_with_slipgym_and_remembers_acts_at_its_own_rate(small):
    changes = {"kinds": ["classic", "learned"], "sensors": "lab", "learned": "", "config": {}}
    study = small(tasks=["FragileHold"], **changes)
    rates = {(one.kind, one.source): one.frame_skip for one in conditions(study, policies_of(study))}
    assert rates["learned", "none"] == 1  # fragile_hold_lab
    assert {rates["learned", "true"], rates["classic", "none"]} == {2}


def test_learned_policies_as_training_left_them(small, shelf):
    runs = [
        f"linear_slip__ppo__20260101/{source}__{seed}/policy"
        for source in ("none", "true")
        for seed in (0, 1)
    ]
    found = policies_of(small(learned=shelf(*runs, "hold__ppo__20260101/true__0/policy")))
    assert {key: [path.parent.name for path in paths.values()] for key, paths in found.items()} == {
        ("learned", "LinearSlip", "none"): ["none__0", "none__1"],
        ("learned", "LinearSlip", "true"): ["true__0", "true__1"],
    }


def test_imitations_are_a_kind_of_their_own(small, shelf):
    folder = shelf("linear_slip_none_0/policy", "linear_slip_none_3/policy", "linear_slip_estimated_0/policy")
    study = small(imitation=folder, kinds=["classic", "imitation"])
    found = policies_of(study)
    assert {key: sorted(paths) for key, paths in found.items()} == {
        ("imitation", "LinearSlip", "none"): [0, 3],
        ("imitation", "LinearSlip", "estimated"): [0],
    }
    assert missing(study, found) == []
    sources = {one.source for one in conditions(study, found) if one.kind == "imitation"}
    assert sources == {"none", "estimated"}
    (notice,) = missing(small(imitation="nowhere", kinds=["imitation"]), {})
    assert "no policy of kind imitation for none;" in notice
    with pytest.raises(ValueError, match="needs the folder"):
        small(kinds=["imitation"])


def test_two_folders_of_one_seed_are_an_error(small, shelf):
    with pytest.raises(ValueError, match="seed 0"):
        policies_of(small(learned=shelf("linear_slip_true", "linear_slip_true_0")))


def test_a_learned_policy_is_told_nominal_values_by_that_of_the_truth(small, shelf):
    study = small(learned=shelf("linear_slip_true_0", "linear_slip_true_1"), kinds=["learned"], blocks=3)
    found = conditions(study, policies_of(study))
    assert {(condition.source, condition.block, condition.policy[-1]) for condition in found} == {
        (source, block, str(block % 2)) for source in ("nominal", "true") for block in range(3)
    }


def _learned(**folders):
    return {
        ("learned", "LinearSlip", source): {seed: Path(name) for seed, name in enumerate(names)}
        for source, names in folders.items()
    }


def test_all_policies_of_a_task_act_at_the_same_rate(small, monkeypatch):
    skips = {"a": 2, "b": 2, "c": 1}
    monkeypatch.setattr("policies.evaluation.experiment.frame_skip_of", skips.get)
    study = small(tasks=["LinearSlip", "Hold"])
    found = conditions(study, _learned(true=["a"], none=["b"]))
    assert {each.kind for each in found if each.task == "LinearSlip"} == {"classic", "learned"}
    assert {each.frame_skip for each in found if each.task == "LinearSlip"} == {2}
    assert {each.frame_skip for each in found if each.task == "Hold"} == {1}
    classic = next(each for each in found if each.task == "LinearSlip" and each.kind == "classic")
    assert classic.experiment(study).steps_per_action == 2
    with pytest.raises(ValueError, match=r"same rate of action only.*a 2, c 1"):
        conditions(study, _learned(true=["a", "c"]))


def test_a_recurrent_policy_acts_at_its_own_rate(small):
    study = small(tasks=["Hold", "LinearSlip"], kinds=["classic", "recurrent"])
    found = conditions(study, {})
    (recurrent,) = {(each.task, each.source, each.frame_skip) for each in found if each.kind == "recurrent"}
    assert recurrent == ("Hold", "none", 2)
    assert {each.frame_skip for each in found if each.kind == "classic"} == {1}
    chosen = next(each for each in found if each.kind == "recurrent").experiment(study)
    assert (chosen.policies[0].title, chosen.steps_per_action) == ("recurrent", 2)


def test_episodes_come_in_pairs(small):
    study = small(kinds=["classic"])
    seeds = {}
    for condition in conditions(study, {}):
        experiment = condition.experiment(study)
        assert experiment.environment_config().contact.model == condition.world.contact
        seeds.setdefault(condition.block, set()).update(trial.seed for trial in plan(experiment))
    assert len(seeds) == 2
    assert all(len(each) == 1 for each in seeds.values())
    assert not seeds[0] & seeds[1]


@pytest.mark.parametrize("task", ["LinearSlip", "Hold"])
def test_one_thing_is_changed_and_the_rest_is_as_it_was(task):
    before = load_randomization("train").of("linear_slip" if task == "LinearSlip" else "hold")
    after = load_randomization(Change("noise_scale", 4.0).of("train", task))
    assert after.noise_scale is not None
    assert after.noise_scale.ends == (4.0, 4.0)
    assert (
        after.model_copy(update={"noise_scale": before.noise_scale, "tasks": {}}).model_dump(
            exclude={"tasks"}
        )
        == before.model_dump()
    )
    jump = load_randomization(Change("friction_jump", 0.7, (1.0, 2.0)).of("train", task)).disturbances[-1]
    assert (jump.kind, jump.probability) == ("friction_jump", 1.0)


def test_a_controller_that_learns_nothing_acts_as_before_the_first_slip():
    controller, unaware = policies.make("hold", exploration=None), NoFrictionInfo("hold")
    width = len(columns(load(), find("Hold"), "true"))
    observations = np.random.default_rng(0).normal(0.0, 0.01, (5, width)).astype(np.float32)
    observations[:, -3:] = 0.0  # no support: what the estimate is does not count
    told, _ = controller.predict(observations)
    alone, _ = unaware.predict(observations[:, :-6])
    np.testing.assert_array_equal(alone, told)
    assert np.ptp(alone) > 0.0
    single, _ = unaware.predict(observations[0, :-6])
    np.testing.assert_array_equal(single, alone[0])
    # deviations belong to estimates, of which its environment shows none
    assert {**unaware.modes, "observation_mode": "deviations"} == policies.modes(controller)


def test_a_folder_of_policies_that_do_not_act_is_refused(small):
    with pytest.raises(ValueError, match="learned = 'nope': small has no policies of the kind 'learned'"):
        narrowed(small(kinds=["classic"]), learned="nope")
    assert narrowed(small(kinds=["classic"]), learned="nope", kinds=["learned"]).learned == "nope"


def test_a_truth_value_of_yaml_is_the_true_friction(small):
    study = small(
        worlds=[{"label": "core", "engine": "planar", "contact": "ellipsoid", "sources": [True, "none"]}]
    )
    assert study.worlds[0].sources == ("true", "none")
