"""What can be drawn per episode: presets, ranges, and errors that name what is wrong."""

import math
import re

import numpy as np
import pytest

from slipgym.config import load_randomization, names
from slipgym.config.distribution import Distribution
from slipgym.config.randomization import Ranges
from slipgym.contact.pressure import OUTER_RADII
from slipgym.tasks import TASKS, configure, find

KEYS = [task.key for task in TASKS.values()]

WRONG = [
    ({"mu": {}}, "mu: unknown key 'mu'; did you mean 'mu_s'", "radius_scale"),
    ({"mu_c": {"uniform": [0.0, 9.0]}}, "mu_c: must lie within 0.01 to 5", "got 0 to 9"),
    (
        {"load_exponent": {"uniform": [-0.5, 0.2]}},
        "load_exponent: must lie within -0.4 to 0.5",
        "got -0.5 to 0.2",
    ),
    ({"load_exponent": {"choices": [0.6]}}, "load_exponent: must lie within -0.4 to 0.5", "got 0.6 to 0.6"),
    ({"friction_by_area": True}, "friction_by_area needs a radius_exponent from 0.25", "0.333333"),
    (
        {"friction_by_area": True, "radius_exponent": {"uniform": [0.2, 0.3]}},
        "friction_by_area needs a radius_exponent from 0.25",
        "0.333333",
    ),
    (
        {
            "friction_by_area": True,
            "radius_exponent": {"choices": [0.3]},
            "load_exponent": {"choices": [0.4]},
        },
        "load_exponent and friction_by_area",
        "exclude each other",
    ),
    (
        {
            "friction_by_area": True,
            "radius_exponent": {"choices": [0.3]},
            "tasks": {"hinge": {"radius_exponent": None}},
        },
        "friction_by_area needs",
        "0.25",
    ),
    ({"friction_by_area": 1}, "friction_by_area = 1", "true or false"),
    ({"mu_c": {"unform": [0.1, 0.2]}}, "mu_c.unform: unknown key", "log_uniform"),
    ({"mu_c": {"uniform": [0.2, 0.3], "choices": [0.2]}}, "mu_c: needs exactly one", "uniform, choices"),
    ({"mu_c": {}}, "mu_c: needs exactly one", "got none"),
    ({"mu_c": {"choices": []}}, "mu_c.choices = ()", "at least 1"),
    ({"mu_c": {"uniform": [0.3, 0.2]}}, "mu_c.uniform: the lower end 0.3", "0.2"),
    ({"lag": {"choices": [math.nan]}}, "lag.choices.0 = nan", "finite"),
    ({"mu_s": {"choices": [1.0]}}, "mu_s needs a mu_c", "above"),
    ({"materials": ["wood"], "mu_c": {"choices": [0.3]}}, "materials are drawn only", "mu_c"),
    ({"pressure": ["flat"]}, "pressure.0 = 'flat'", "hertz"),
    ({"disturbances": [{"kind": "pusch"}]}, "disturbances.0: unknown kind 'pusch'", "mass_change"),
    ({"disturbances": [{}]}, "disturbances.0: unknown kind None", "mass_change"),
    ({"disturbances": 3}, "disturbances = 3", "a list"),
    ({"tasks": {"hinj": {}}}, "unknown task 'hinj'", "did you mean 'hinge'"),
    ({"tasks": {"hinge": {"mu_s": {"choices": [1.0]}}}}, "tasks.hinge: mu_s needs", "mu_c"),
    (3, "randomization = 3", "eval_ood, lab, none, train"),
]


@pytest.mark.parametrize(("values", "what", "valid"), WRONG, ids=[str(row[0]) for row in WRONG])
def test_what_is_wrong_is_named_with_what_is_valid(values, what, valid):
    with pytest.raises(ValueError, match=re.escape(what)) as caught:
        load_randomization(values, KEYS)
    assert valid in str(caught.value)


def test_a_kind_that_happens_once_is_not_listed_twice():
    jump = {
        "kind": "friction_jump",
        "probability": 1,
        "time": {"choices": [1]},
        "factor": {"choices": [2.0]},
    }
    with pytest.raises(ValueError, match="disturbances hold 2 of kind friction_jump; at most 1"):
        load_randomization({"disturbances": [jump, jump]})


def test_a_file_is_named_in_its_faults(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("mass_scale: {uniform: [0.5, 20.0]}")
    with pytest.raises(ValueError, match=r"mine\.yaml: mass_scale: must lie within 0\.1 to 10"):
        load_randomization(path)
    path.write_text("mass_scale: {uniform: [0.5, 2.0]}")
    assert load_randomization(str(path)) == load_randomization({"mass_scale": {"uniform": [0.5, 2.0]}})
    with pytest.raises(FileNotFoundError, match=r"absent\.yaml"):
        load_randomization("absent.yaml")


@pytest.mark.parametrize("kind", ["uniform", "log_uniform", "choices"])
def test_a_distribution_is_what_it_says(kind):
    drawn = Distribution(**{kind: (0.5, 2.0)})
    values = np.array([drawn.at(share) for share in np.linspace(0.0, 1.0, 1000, endpoint=False)])
    assert values.min() == 0.5
    assert values.max() == pytest.approx(2.0, rel=2e-3)
    assert drawn.at(np.nextafter(1.0, 0.0)) <= 2.0
    middle = {"uniform": 1.25, "log_uniform": 1.0, "choices": 2.0}[kind]
    assert drawn.at(0.5) == pytest.approx(middle)


def test_a_tasks_own_fields_replace_the_common_ones():
    both = load_randomization(
        {
            "mu_c": {"choices": [0.3]},
            "lag": {"choices": [0.01]},
            "tasks": {"hinge": {"mu_c": {"choices": [0.5]}, "lag": None}},
        }
    )
    assert both.of("hinge") == Ranges(mu_c=Distribution(choices=(0.5,)))
    assert both.of("hold").lag == Distribution(choices=(0.01,))


def test_a_tasks_own_field_may_need_a_common_one():
    common = {"mu_c": {"uniform": [0.2, 0.3]}, "radius_exponent": {"uniform": [0.25, 0.3]}}
    own = {"mu_s": {"uniform": [0.4, 0.5]}, "friction_by_area": True}
    drawn = load_randomization({**common, "tasks": {"hold": own}})
    assert drawn.of("hold").friction_by_area
    assert not drawn.of("hinge").friction_by_area
    with pytest.raises(ValueError, match=r"tasks\.hold: load_exponent and friction_by_area exclude"):
        load_randomization({**common, "load_exponent": {"choices": [0.1]}, "tasks": {"hold": own}})


def test_none_draws_nothing():
    assert all(load_randomization("none").of(task) == Ranges() for task in KEYS)


@pytest.mark.parametrize("preset", names("randomization"))
def test_a_preset_survives_json(preset):
    loaded = load_randomization(preset)
    again = load_randomization(loaded.model_dump(mode="json", exclude_unset=True))
    assert all(again.of(task) == loaded.of(task) for task in KEYS)


def test_eval_ood_goes_beyond_train():
    train, beyond = (load_randomization(name) for name in ("train", "eval_ood"))
    fields = [name for name in Ranges.model_fields if isinstance(getattr(train, name), Distribution)]
    for name in fields:
        inner, outer = getattr(train, name).ends, getattr(beyond, name).ends
        assert outer[0] <= inner[0] <= inner[1] <= outer[1]
        assert outer != inner
    assert len(fields) >= 14


@pytest.mark.parametrize("task", KEYS)
def test_train_keeps_the_tasks_feasible(task):
    """At the worst corner of all ranges the grip that holds the object leaves a fifth of the range."""
    (config, settings), ranges = configure(find(task)), load_randomization("train").of(task)
    thing = settings.object or config.object

    def ends(name, nominal=1.0):
        drawn = getattr(ranges, name)
        return drawn.ends if drawn else (nominal, nominal)

    mass = (settings.mass_range or (thing.mass, thing.mass))[1] * ends("mass_scale")[1]
    own = config.gripper.pad_radius / max(OUTER_RADII[name] for name in ranges.pressure or ("uniform",))
    r = (settings.radius or own) * ends("radius_scale")[0] * ends("finger_radius")[0]
    seconds = settings.duration + getattr(settings, "settle", 0.0) + getattr(settings, "hold", 0.0)
    mu_c = ends("mu_c")[0] * ends("finger_friction")[0] * math.exp(seconds * ends("friction_drift", 0.0)[0])
    aside = ends("size_scale")[1] * (abs(thing.grasp_offset[0]) + ends("com_x", 0.0)[1] * thing.size[0])
    if task == "planar_slip":  # after the longest slide the object is turned to the side
        aside += settings.slide[1]
    if task == "pivot_to":  # at the end of the largest turn the object is beside the pads
        deep = thing.grasp_offset[1] + ends("com_z", 0.0)[1] * thing.size[2]
        aside += ends("size_scale")[1] * deep * math.sin(settings.angle[1])
        mu_c *= settings.friction_range[0]
    aside += ends("cop_offset", 0.0)[1]
    needed = 0.5 * mass * config.physics.gravity * math.hypot(1.0, aside / r) / mu_c
    needed /= ends("force_gain")[0]
    assert needed < 0.8 * config.gripper.force_max
    if task == "linear_slip":  # and the lightest object slides at the smallest grip
        weight = thing.mass * ends("mass_scale")[0] * config.physics.gravity
        mu_s = ends("mu_c")[1] * ends("friction_ratio")[1] * ends("finger_friction")[1]
        assert 2.0 * config.gripper.force_min * ends("force_gain")[1] * mu_s < 0.9 * weight


def test_the_old_name_of_a_surface_region_warns():
    region = {
        "probability": 1.0,
        "start": {"choices": [0.01]},
        "length": {"choices": [0.01]},
        "factor": {"choices": [0.7]},
    }
    with pytest.warns(DeprecationWarning, match="'patch' is now 'surface_region'"):
        old = load_randomization({"disturbances": [{"kind": "patch", **region}]})
    assert old == load_randomization({"disturbances": [{"kind": "surface_region", **region}]})
