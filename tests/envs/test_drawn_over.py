"""Values that are given by hand in `config` act, or a warning says what draws them."""

import warnings

import gymnasium as gym
import pytest

from slipgym.tasks import TASKS, configure
from slipgym.tasks.configure import recorded


def made(task, **arguments):
    return gym.make(f"slipgym:slipgym/{task}-v0", engine="planar", disable_env_checker=True, **arguments)


@pytest.mark.parametrize("task", ["Hold", "FragileHold", "Carry", "Explore", "LinearSlip"])
def test_a_mass_given_by_hand_is_not_drawn_over(task):
    config, settings = configure(TASKS[task], {"object": {"mass": 0.3}})
    assert (config.object.mass, settings.mass_range) == (0.3, None)
    own = {"object": {"mass": 0.3}, "tasks": {TASKS[task].key: {"mass_range": [0.1, 0.2]}}}
    assert configure(TASKS[task], own)[1].mass_range == (0.1, 0.2)


def test_the_mass_of_episodes_is_the_one_given():
    env = made("Hold", config={"object": {"mass": 0.3}}).unwrapped
    assert {env.reset(seed=seed) and env.simulation.boxes[0].mass for seed in range(3)} == {0.3}
    env.close()


@pytest.mark.parametrize("task", ["Hinge", "PivotTo", "PlanarSlip", "RotationalSlip"])
def test_a_task_with_an_object_of_its_own_takes_what_is_given(task):
    default = configure(TASKS[task])[1].object
    heavier = configure(TASKS[task], {"object": {"mass": 0.4}})[1].object
    assert heavier == default.model_copy(update={"mass": 0.4})
    config, settings = configure(TASKS[task], {"object": {"size": [0.06, 0.02, 0.1]}})
    assert (config.object.size, settings.object) == ((0.06, 0.02, 0.1), None)


def test_points_of_an_object_given_in_part_lie_in_the_box_of_its_task():
    settings = configure(TASKS["RotationalSlip"], {"object": {"grasp_offset": [-0.1, 0.0]}})[1]
    assert settings.object.grasp_offset == (-0.1, 0.0)
    with pytest.raises(ValueError, match=r"^config argument: object: com_offset .*\(0.46, 0.03, 0.04\)"):
        configure(TASKS["RotationalSlip"], {"object": {"com_offset": [0.3, 0.0]}})


@pytest.mark.parametrize("task", ["Hold", "Hinge"])
def test_an_object_given_in_part_completes_that_of_the_level(task):
    whole = {
        "mass": 0.5,
        "size": [0.1, 0.03, 0.3],
        "com_offset": [0.0, 0.0],
        "inertia": None,
        "grasp_offset": [0.0, 0.0],
    }
    env = made(task, level={"settings": {"object": whole}}, config={"object": {"mass": 0.3}}).unwrapped
    env.reset(seed=0)
    box = env.simulation.boxes[0]
    assert (box.mass, box.size) == (0.3, (0.1, 0.03, 0.3))
    env.close()


@pytest.mark.parametrize("task", TASKS)
def test_so_do_radius_and_speed_of_the_wrist(task):
    given = {"contact": {"radius": 0.007}, "gripper": {"wrist_speed_max": 0.4}}
    settings = configure(TASKS[task], given, level=None)[1]
    assert (settings.radius, settings.radius_range, settings.wrist_speed) == (None, None, None)


@pytest.mark.parametrize("task", TASKS)
def test_a_whole_configuration_changes_nothing(task):
    config, settings = configure(TASKS["LinearSlip"])
    whole = recorded(config, settings, "linear_slip")
    assert configure(TASKS[task], whole)[1] == configure(TASKS[task])[1]


@pytest.mark.parametrize(
    ("task", "arguments", "key"),
    [
        ("Hold", {"config": {"gripper": {"lag": 0.02}}, "randomization": "train"}, "gripper.lag"),
        (
            "Hold",
            {"config": {"gripper": {"lag": 0.02}}, "randomization": {"lag": {"choices": [0.01]}}},
            "lag",
        ),
        (
            "LinearSlip",
            {"config": {"contact": {"pad": {"creep": 0.2}}}, "randomization": {"creep": {"choices": [0.1]}}},
            "contact.pad.creep",
        ),
        (
            "LinearSlip",
            {"config": {"materials": {"wood": {"mu_c": 0.3}}}, "level": "hard"},
            r"materials\.wood has .* material='wood'",
        ),
        ("Carry", {"config": {"materials": {"wood": {"mu_c": 0.3}}}}, r"materials\.wood .* material='wood'"),
        (
            "Carry",
            {
                "config": {"tasks": {"carry": {"friction_range": [0.2, 0.3]}}},
                "level": {"randomization": {"mu_c": {"uniform": [0.4, 0.5]}}},
            },
            "tasks.carry.friction_range",
        ),
    ],
)
def test_a_value_that_is_drawn_over_is_named(task, arguments, key):
    with pytest.warns(UserWarning, match=rf"^config argument: .*{key}"):
        env = made(task, **arguments)
    whole = env.unwrapped._arguments["config"]
    env.close()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        made(task, **{**arguments, "config": whole}).close()


def test_what_acts_needs_no_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        given = {"materials": {"wood": {"mu_c": 0.3}}, "gripper": {"lag": 0.02}}
        made("Carry", config=given, material="wood", level="hard").close()
        made("LinearSlip", config=given).close()
