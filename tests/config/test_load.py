"""What a user may pass, and what is said when it is wrong."""

import copy
import math
import pickle

import pytest
from pydantic import ValidationError

from slipgym import config


def test_defaults_are_the_papers_figures():
    c = config.load()
    assert (c.gripper.pad_radius, c.gripper.force_limit, c.gripper.lag) == (0.015, 40.0, 0.012)
    assert (c.contact.sigma_0, c.contact.sigma_1, c.contact.sigma_2) == (1e6, 80.0, 0.2)
    assert c.contact_radius == pytest.approx(2 / 3 * c.gripper.pad_radius)
    assert (c.materials["wood"].mu_c, c.materials["wood"].mu_s) == (0.3623, 0.5155)
    assert c.physics.engine_rate == 480


def test_presets_differ_in_what_they_say_they_do():
    ideal, realistic = (config.load(sensors=name).sensors for name in ("ideal", "realistic"))
    assert ideal.force_torque.noise_tangential == 0.0 < realistic.force_torque.noise_tangential
    assert not ideal.slip.counts
    assert realistic.slip.counts
    assert ideal.slip.latency_samples == 0 < realistic.slip.latency_samples


def test_names():
    assert config.names("materials") == ("cardboard", "case", "plastic", "wood")
    assert config.names("sensors") == ("ideal", "lab", "markers", "motor", "realistic", "wrist")
    assert config.names("randomization") == ("eval_ood", "lab", "none", "train")
    with pytest.raises(ValueError, match="materials, randomization, sensors"):
        config.names("colours")


@pytest.mark.parametrize("name", ["reallistic", ["ideal"], None])
def test_unknown_preset_names_the_known(name):
    with pytest.raises(ValueError, match="ideal, lab, markers, motor, realistic, wrist"):
        config.load(sensors=name)


def test_a_mapping_is_merged_deeply_and_leaves_the_defaults_alone():
    default = config.load()
    c = config.load({"object": {"mass": 0.3, "size": [0.1, 0.02, 0.2]}})
    assert (c.object.mass, c.object.size) == (0.3, (0.1, 0.02, 0.2))
    assert c.object.com_offset == default.object.com_offset
    assert config.load() == default


def test_a_file_says_the_same_as_a_mapping(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("sensors: {slip: {window: 4}}\ncontact: {stribeck_velocity: 2e-3}\n")
    same = {"sensors": {"slip": {"window": 4}}, "contact": {"stribeck_velocity": 2e-3}}
    assert config.load(path) == config.load(str(path)) == config.load(same)


def test_an_empty_file_changes_nothing(tmp_path):
    path = tmp_path / "empty.yaml"
    path.write_text("# nothing\n")
    assert config.load(path) == config.load()


def test_a_material_can_be_added_and_changed():
    c = config.load({"materials": {"rubber": {"mu_c": 0.8, "mu_s": 1.0}, "wood": {"mu_s": 0.6}}})
    assert c.materials["rubber"].mu_s == 1.0
    assert (c.materials["wood"].mu_c, c.materials["wood"].mu_s) == (0.3623, 0.6)


def test_inertia_of_a_uniform_box_unless_given():
    assert config.load().object.grip_axis_inertia == pytest.approx(0.2 * (0.08**2 + 0.16**2) / 12)
    assert config.load({"object": {"inertia": 1e-3}}).object.grip_axis_inertia == 1e-3


def test_frozen_copyable_and_picklable():
    c = config.load()
    with pytest.raises(ValidationError, match="frozen"):
        c.object.mass = 1.0
    assert copy.deepcopy(c) == c == pickle.loads(pickle.dumps(c))


def test_what_a_run_records_loads_again():
    c = config.load({"object": {"mass": 0.3}}, sensors="ideal")
    assert config.load(c.model_dump(mode="json")) == c


WRONG = [
    ({"gripper": {"pad_radus": 0.01}}, ["gripper.pad_radus", "did you mean 'pad_radius'", "force_max"]),
    ({"griper": {}}, ["griper", "did you mean 'gripper'", "sensors"]),
    ({1: 2}, ["unknown key 1", "gripper"]),
    ({"materials": {"rubber": {"mu_c": 0.5, "mu_s": 0.6, "r": 1}}}, ["materials.rubber.r", "mu_c, mu_s"]),
    ({"materials": {"rubber": {"mu_c": 0.5}}}, ["materials.rubber.mu_s is missing", ">= 0.001"]),
    ({"materials": {"wood": {"mu_s": 0.1}}}, ["materials.wood", "mu_s >= mu_c", "0.1", "0.3623"]),
    ({"materials": {3: {"mu_c": 0.5, "mu_s": 0.6}}}, ["materials", "text", "3"]),
    ({"nominal": {"mu_c": 0.9}}, ["nominal", "mu_s >= mu_c"]),
    ({"object": {"mass": -1.0}}, ["object.mass = -1.0", ">= 0.001", "[kg]"]),
    ({"object": {"mass": "0.2"}}, ["object.mass = '0.2'", "a finite number >= 0.001"]),
    ({"object": {"mass": True}}, ["object.mass = True", "a finite number"]),
    ({"object": {"mass": None}}, ["object.mass = None", "a finite number"]),
    ({"object": {"mass": math.nan}}, ["object.mass = nan", "finite"]),
    ({"object": {"com_offset": [0.0, math.inf]}}, ["object.com_offset.1 = inf", "finite"]),
    ({"object": {"com_offset": [0.0, 0.09]}}, ["com_offset", "outside"]),
    ({"object": {"size": [1, 2, 3, 4]}}, ["object.size", "a list of 3"]),
    ({"object": {"size": [0.1, 0.1, 0]}}, ["object.size.2 = 0", ">= 0.001"]),
    ({"object": {"inertia": 0.0}}, ["object.inertia = 0.0", "or null"]),
    ({"object": 3}, ["object = 3", "a mapping"]),
    ({"sensors": "ideal"}, ["sensors = 'ideal'", "a mapping"]),
    ({"sensors": {"slip": {"counts": 1}}}, ["sensors.slip.counts = 1", "true or false"]),
    ({"sensors": {"slip": {"rate": 60}}}, ["sensors.slip.rate", "60", "120"]),
    ({"physics": {"engine_steps": 2.5}}, ["physics.engine_steps = 2.5", "a whole number >= 1"]),
    ({"contact": {"model": "point"}}, ["contact.model = 'point'", "'ellipsoid', 'disc', 'distributed'"]),
    ({"contact": {"sigma_0": 10.0}}, ["contact.sigma_0 = 10.0", ">= 100000"]),
    ({"contact": {"radius": 0.02}}, ["contact.radius", "gripper.pad_radius", "0.02", "0.015"]),
    ({"contact": {"cop_offset": [[0, 0], [0, "a"]]}}, ["contact.cop_offset.1.1 = 'a'", "finite"]),
    ({"gripper": {"force_max": 50.0}}, ["gripper", "force_max <= force_limit", "50", "40"]),
]


@pytest.mark.parametrize(("overrides", "said"), WRONG, ids=[str(wrong)[:60] for wrong, _ in WRONG])
def test_a_fault_names_its_place_and_what_is_valid(overrides, said):
    with pytest.raises(ValueError, match=r"^config argument: ") as caught:
        config.load(overrides)
    for part in said:
        assert part in str(caught.value)


def test_all_faults_are_told_at_once():
    with pytest.raises(ValueError, match=r"gripper\.lag = -1.*\n.*object\.mass = 0") as caught:
        config.load({"object": {"mass": 0}, "gripper": {"lag": -1}})
    assert len(str(caught.value).splitlines()) == 2


@pytest.mark.parametrize("wrong", [3, ["object"], True])
def test_overrides_of_another_kind_are_refused(wrong):
    with pytest.raises(ValueError, match="a mapping or a path"):
        config.load(wrong)
