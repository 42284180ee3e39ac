"""A reward term and a column keep their names whatever their place."""

import dataclasses

import numpy as np
import pytest

from slipgym.tasks import TASKS, Column, term
from slipgym.tasks.episode import EPISODE, OWN_MAX, scratch
from slipgym.world.records import FINGER, WORLD


def evaluated(task):
    """Reward terms and columns of a task in some state, by their names."""
    episodes, worlds, fingers = np.zeros(1, EPISODE), np.zeros(1, WORLD), np.zeros((1, 2), FINGER)
    rng = np.random.default_rng(0)
    for field in ("reference", "wrist_command"):
        episodes[field] = rng.uniform(0.1, 0.2, episodes[field].shape)
    episodes["own"] = rng.uniform(0.001, 0.002, episodes["own"].shape)
    if task.key.startswith("carry"):
        episodes["own"] *= 600.0  # N: `thrift` is then within its bounds
    for field in ("slip", "slip_twist", "wrist", "wrist_velocity", "wrist_plan"):
        worlds[field] = rng.uniform(0.001, 0.002, worlds[field].shape)
    episodes["step_time"], episodes["steps"], episodes["reach"], episodes["scales"] = 0.01, 50, 1.0, 1.0
    for field in ("tolerance", "slide_tolerance", "tilt_tolerance", "duration", "pad_radius"):
        episodes[field] = 0.01
    for field in ("force_max", "wrist_speed_max", "wrist_pitch_rate_max", "goal"):
        episodes[field] = 3.0
    episodes["command"], episodes["step"] = 2.5, 1
    fingers["force"] = fingers["contact_force"] = 2.0
    columns = np.zeros((1, len(task.columns)))
    task.evaluate_step(episodes, worlds, fingers, columns)
    terms = dict(zip(task.term_names, episodes["terms"][0].tolist(), strict=False))
    return terms, dict(zip([column.name for column in task.columns], columns[0].tolist(), strict=True))


@pytest.mark.parametrize("task", TASKS.values(), ids=list(TASKS))
@pytest.mark.quick_cases("LinearSlip")
def test_names_follow_values_when_rows_change_places(task):
    terms, columns = evaluated(task)
    dense = [terms[term.name] for term in task.terms if not term.event]
    assert len(set(dense)) == len(dense)  # else the order could not show
    changed = dataclasses.replace(
        task, terms=task.terms[::-1], columns=(*task.columns[1:], task.columns[0]), key=f"{task.key}_turned"
    )
    turned_terms, turned_columns = evaluated(changed)
    assert list(turned_terms) == list(terms)[::-1]
    assert turned_terms == terms
    assert turned_columns == columns


def test_a_new_term_and_a_new_column_are_one_row_each():
    @term(scale=2.0)
    def grip(episode, world, fingers):
        """Sum of the actuator forces over 8 N."""
        return (fingers[0].force + fingers[1].force) / 8.0

    def spin(episode, world, fingers):
        return 2.0 * world.slip_twist[2]

    task = TASKS["LinearSlip"]
    rows = Column("spin", -1.0, 1.0, "rad/s", "twice the slip rate", spin)
    changed = dataclasses.replace(task, terms=(grip, *task.terms), columns=(rows, *task.columns), key="more")
    terms, columns = evaluated(changed)
    before_terms, before_columns = evaluated(task)
    assert terms == {"grip": 0.5 / 50, **before_terms}
    assert columns == {"spin": pytest.approx(columns["spin"]), **before_columns}
    assert columns["spin"] != 0.0
    assert grip.meaning == "Sum of the actuator forces over 8 N"


def test_scratch_numbers_have_names_and_places_of_their_own():
    places = scratch(target=3, speed=1, angle=1)
    own = np.arange(OWN_MAX)
    assert own[places.target].tolist() == [0, 1, 2]
    assert (own[places.speed], own[places.angle]) == (3, 4)
    for sizes in ({"a": OWN_MAX, "b": 1}, {"a": 0}):
        with pytest.raises(ValueError, match="at least 1 each"):
            scratch(**sizes)
