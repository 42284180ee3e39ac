"""The planar engine against PyBullet in whole episodes."""

import numpy as np
import pytest

from lab.engines import Replay, Tape, apart, compare, evenly, halved
from lab.reproduction.published import TABLES
from policies.evaluation import load_experiment
from policies.evaluation.plan import plan
from policies.evaluation.trial import make_policy, record

# PyBullet's bench and the planar one are 0.1 mm apart after 5 s of stick-slip (validation/planar.py); an
# episode of half a second that does not stick meanwhile has a tenth of it
SHORT = {"duration": 0.4, "settle": 0.05, "hold": 0.05}


@pytest.fixture
def sliding(small):
    return small(policies=[{"name": "linear_slip"}], options=SHORT, vary={"distance": [0.01]})


def test_a_replay_repeats_an_episode(sliding):
    trial = plan(sliding)[0]
    tape = Tape(make_policy(sliding, trial))
    first = record(sliding, trial, tape)
    again = record(sliding, trial, Replay(tape.actions, tape.modes))
    assert len(tape.actions) == len(first.time)
    np.testing.assert_array_equal(again.slip, first.slip)
    assert apart(first, again) == (0.0, 0.0)


def test_episodes_of_both_engines_end_alike(sliding):
    table = compare(sliding, 3, progress=False)
    assert list(table["trials"]) == [3, 3, 3]
    same = table[table["against PyBullet"].str.contains("same actions")]
    assert (same["95 % [mm]"] < 0.05).all()
    assert (same["95 % [deg]"] < 0.05).all()
    assert (same["median [mm]"] > 0.0).all()
    assert (table["success [%]"] == table["success, PyBullet [%]"]).all()


def test_trials_are_spread_over_the_cells(small):
    trials = evenly(small(), 5)
    assert [trial.number for trial in trials] == [0, 0, 0, 0, 1]
    assert len({(trial.material, trial.options["distance"]) for trial in trials}) == 4
    assert {trial.friction.source for trial in trials} == {"estimated"}


def test_halved_halves_all_steps_and_keeps_the_rest(small):
    coarse = small(config={"physics": {"gravity": 9.8, "substep_max": 2e-4}})
    physics = halved(coarse).environment_config().physics
    assert (physics.gravity, physics.engine_steps) == (9.8, 8)
    assert physics.substep_max == 1e-4
    assert physics.planar_substep_max == coarse.environment_config().physics.planar_substep_max / 2


def test_refusals(small):
    with pytest.raises(ValueError, match="trials = 0 must be at least 1"):
        compare(small(), 0)
    with pytest.raises(ValueError, match=r"engine 'mujoco'.*bullet.*planar"):
        small(engine="mujoco")


DISTINCT = {"linear_slip": 16, "rotational_slip": 32, "hinge": 32}
"""Episodes that differ if sensors are ideal; a turn to the other side is the mirror image."""


def acceptance(name, sensors):
    """Experiment and number of episodes: 200, or those that differ, each once."""
    experiment = load_experiment(name).model_copy(update={"sensors": sensors})
    if sensors == "realistic" or name not in DISTINCT:
        return experiment, 200
    vary = {**experiment.vary, **({"direction": [1]} if name == "hinge" else {})}
    experiment = experiment.model_copy(update={"materials": list(TABLES["linear"]), "vary": vary})
    assert len(experiment.materials) * len(experiment.combinations()) == DISTINCT[name]
    return experiment, DISTINCT[name]


@pytest.mark.slow
@pytest.mark.parametrize("sensors", ["realistic", "ideal"])
@pytest.mark.parametrize("name", ["linear_slip", "rotational_slip", "hinge", "planar_slip", "hold"])
def test_acceptance_of_the_planar_engine(name, sensors):
    """Hinge amplifies differences: PyBullet's steps matter more there than the engine."""
    amplifies = name == "hinge"
    table = compare(*acceptance(name, sensors), progress=False, halving=amplifies)
    table = table.set_index("against PyBullet")
    closed, same = table.loc["planar, same controller"], table.loc["planar, same actions"]
    bounds = {"median [mm]": 0.2, "median [deg]": 0.2, "95 % [mm]": 0.5, "95 % [deg]": 0.5}
    if amplifies:
        # half is no derived figure: with ideal sensors the engines were 0.72 deg apart and the steps 3.0 deg,
        # with realistic ones 0.97 and 2.4 deg
        bounds["95 % [deg]"] = 0.5 * table.loc["PyBullet halved, same actions", "95 % [deg]"]
    assert {line: same[line] for line, bound in bounds.items() if not same[line] < bound} == {}
    assert abs(closed["success [%]"] - closed["success, PyBullet [%]"]) <= 2.0
