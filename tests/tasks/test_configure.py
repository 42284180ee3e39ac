"""Settings of a task: where they come from, what is refused, which of them a reset can fix."""

import copy
import pickle
import re

import pytest

from slipgym.tasks import TASKS, Option, TaskConfig, configure, find
from slipgym.tasks.configure import recorded

WRONG = [
    ({"gripper": {"force_max": 10.0}}, "tasks.linear_slip.initial_force must lie within", "got 15 N"),
    ({"tasks": {"linear_slip": {"radius": 0.02}}}, "tasks.linear_slip.radius must not exceed", "0.015 m"),
    ({"tasks": {"linear_slip": {"distance": -1.0}}}, "tasks.linear_slip.distance = -1.0: must be", "[m]"),
    ({"tasks": {"linear_slip": {"distance": 0.3}}}, "tasks.linear_slip.distance = 0.3", "<= 0.2"),
    ({"tasks": {"linear_slip": {"distanse": 0.1}}}, "tasks.linear_slip.distanse: unknown key", "'distance'"),
    ({"tasks": {"linear_slip": {"reward": {"efort": 1.0}}}}, "reward.efort: unknown key", "'effort'"),
    ({"tasks": {"linear_slip": {"reward": {"effort": "1"}}}}, "reward.effort = '1'", "a finite number"),
    ({"tasks": {"linear_slip": 3}}, "tasks.linear_slip = 3 must be a mapping", ""),
    ({"tasks": 3}, "tasks = 3 must be a mapping", ""),
    ({"tasks": {"holt": {}}}, "tasks.holt: unknown key 'holt'; did you mean 'hold'", "planar_slip"),
    ({"tasks": {"hold": {"mass_range": [0.4, 0.1]}}}, "tasks.hold.mass_range", "lower end 0.4"),
]


@pytest.mark.parametrize(("overrides", "what", "valid"), WRONG, ids=[str(row[0]) for row in WRONG])
def test_what_is_wrong_is_named_with_what_is_valid(overrides, what, valid):
    with pytest.raises(ValueError, match=re.escape(what)) as caught:
        configure(TASKS["LinearSlip"], overrides)
    assert str(caught.value).startswith("config argument: ")
    assert valid in str(caught.value)


def test_a_group_differs_where_it_says_so(tmp_path):
    default, changed = (configure(TASKS["Hold"], o)[1] for o in (None, {"tasks": {"hold": {"duration": 2}}}))
    assert changed.duration == 2.0
    assert changed == default.model_copy(update={"duration": 2.0})
    path = tmp_path / "mine.yaml"
    path.write_text("tasks: {hold: {duration: 2}}")
    assert configure(TASKS["Hold"], path)[1] == changed


def test_the_object_of_a_task_is_merged_key_by_key():
    light = configure(TASKS["Hinge"], {"tasks": {"hinge": {"object": {"mass": 0.1}}}})[1].object
    assert light is not None
    assert (light.mass, light.size) == (0.1, (0.05, 0.03, 0.25))


@pytest.mark.parametrize("task", TASKS.values(), ids=list(TASKS))
def test_what_is_recorded_loads_again_and_copies_are_equal(task):
    config, settings = made = configure(task, {"object": {"mass": 0.3}}, "ideal", "distributed")
    assert configure(task, recorded(config, settings, task.key)) == made
    assert copy.deepcopy(made) == made == pickle.loads(pickle.dumps(made))


@pytest.mark.parametrize("task", TASKS.values(), ids=list(TASKS))
def test_every_setting_says_what_it_is(task):
    assert issubclass(task.settings, TaskConfig)
    for field in (*task.settings.model_fields.values(), *task.options.model_fields.values()):
        assert len(field.description) > 10
        assert "[]" not in field.description


def test_options_are_the_settings_that_a_reset_can_fix():
    task = TASKS["LinearSlip"]
    own = ["distance", "duration", "settle", "hold", "tolerance", "initial_force"]
    assert set(own) < set(task.options.model_fields)
    assert "radius" not in task.options.model_fields
    settings = configure(task)[1]
    fixed = task.options.parse({"distance": 0.02, "material": "wood"}).applied_to(settings)
    assert fixed == settings.model_copy(update={"distance": 0.02})
    with pytest.raises(ValueError, match=r"option distance = 0\.3: .*less than or equal to 0\.2.*\[m\]"):
        task.options.parse({"distance": 0.3})


def test_an_option_may_have_another_type_than_its_setting():
    task = TASKS["PlanarSlip"]
    options = task.options.parse({"slide": 0.012})
    settings = configure(task)[1]
    assert options.applied_to(settings) is settings
    assert options.slide == 0.012
    assert isinstance(task.settings.model_fields["slide"].json_schema_extra, Option)


@pytest.mark.parametrize("name", ["linear_slip", "LinearSlip", "slipgym/LinearSlip-v0"])
def test_a_task_is_found_by_each_of_its_names(name):
    assert find(name) is TASKS["LinearSlip"]


def test_an_unknown_task_names_the_known():
    with pytest.raises(ValueError, match="unknown task 'linear_slide'; did you mean 'linear_slip'"):
        find("linear_slide")
