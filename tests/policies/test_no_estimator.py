"""Policies in environments with `estimator=None`."""

import json

import gymnasium as gym
import numpy as np
import pytest

import policies
from lab.leaderboard.closed_loop import played
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.evaluation import load_experiment
from policies.evaluation.one_policy import episodes
from policies.evaluation.plan import plan
from policies.evaluation.trial import run_trials
from policies.learned.description import Environment as Trained
from policies.learned.fitting import check_environment, column_of
from policies.play.viewer.controls import status
from policies.play.viewer.plots import Plots, SurfacePlot
from policies.play.viewer.session import Session
from policies.play.watch import watch
from policies.training.config import Environment
from policies.training.imitation import config as imitation
from slipgym.registration import TASK_MODULES
from slipgym.tasks import find
from tests.policies.test_viewer_plots import Gui

REFUSED = r"controller 'linear_slip' acts on estimates: this environment has estimator=None"
CELL = {
    "name": "short",
    "task": "linear_slip",
    "trials": 2,
    "options": {"duration": 0.2},
    "engine": "planar",
}


def experiment(policy, **friction):
    return load_experiment({**CELL, "policies": [{"name": policy}], "friction": [friction]})


@pytest.mark.parametrize("env_id", TASK_MODULES)
def test_the_controller_of_every_task_is_refused(env_id):
    key = find(env_id).key
    policy = policies.make(key)
    with pytest.raises(ValueError, match=f"controller '{key}' acts on estimates"):
        policies.check_estimates(key, policy, {"estimator": None})
    for arguments in ({}, {"estimator": "rls"}, {"estimator": None, "friction_source": "true"}):
        policies.check_estimates(key, policy, arguments)
    policies.check_estimates("", NoFrictionInfo(key), {"estimator": None})


@pytest.mark.parametrize(
    "run",
    [
        lambda: watch("linear_slip", video="never.gif", estimator=None),
        lambda: list(episodes("linear_slip", 1, changes={"estimator": None})),
        lambda: played("slipgym/LinearSlip-v0", 2, 0, estimator=None),
    ],
)
def test_it_is_refused_where_it_is_built(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=REFUSED):
        run()
    assert list(tmp_path.iterdir()) == []


def test_a_controller_by_hand_says_what_leaves_the_column_out():
    env = gym.make("slipgym/LinearSlip-v0", engine="planar", estimator=None)
    observation, _ = env.reset(seed=0)
    with pytest.raises(ValueError, match=r"needs the column .* leave out, as estimator=None does"):
        policies.make("linear_slip").predict(observation)
    action, _ = NoFrictionInfo("linear_slip").predict(observation)
    assert env.action_space.contains(action)
    env.close()


def test_an_experiment_has_no_estimate_to_report():
    short = experiment("linear_slip", source="estimated", estimator=None)
    with pytest.raises(ValueError, match=REFUSED):
        run_trials(short, plan(short), progress=False)
    short = experiment("linear_slip", source="true", estimator=None)
    rows = [result.row for result in run_trials(short, plan(short), progress=False)]
    assert [row["estimator"] for row in rows] == ["null", "null"]
    assert np.isnan([row["final_mu_c"] for row in rows]).all()
    assert np.isfinite([row["true_mu_c"] for row in rows]).all()


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_an_experiment_is_the_same_without_an_estimator(engine):
    """The controller reads the truth: what the estimates would be is all that may differ."""
    found = []
    for friction in ({}, {"estimator": None}):
        short = experiment("linear_slip", source="true", **friction).model_copy(update={"engine": engine})
        found.append([result.row for result in run_trials(short, plan(short), progress=False)])
    for one, other in zip(*found, strict=True):
        same = [name for name in one if not name.startswith(("final_mu", "final_r_", "cruise", "estimator"))]
        assert {name: one[name] for name in same} == {name: other[name] for name in same}


def test_configurations_take_null():
    assert Environment(estimator=None).model_dump(mode="json")["estimator"] is None
    first, _ = plan(experiment("linear_slip", source="none", estimator=None))
    assert json.loads(first.keys["estimator"]) is None
    blind = {"friction_source": "none", "estimator": None}
    base = {"task": "linear_slip", "memory": 0, "layers": [4], "environment": blind}
    assert imitation.read(base).environment.estimator is None
    message = r"teacher 'estimate' acts on estimates: environment\.estimator is null"
    with pytest.raises(ValueError, match=message):
        imitation.read({**base, "teacher": "estimate"})


def test_a_learned_policy_reads_what_it_was_trained_on():
    env = gym.make("slipgym/LinearSlip-v0", engine="planar", estimator=None).unwrapped
    trained = Trained(
        id="slipgym/LinearSlip-v0",
        arguments={"estimator": None},
        rate=120.0,
        history=0,
        observation=[column_of(column) for column in env.columns],
        action=[column_of(column) for column in env.action_columns],
    )
    check_environment(trained, env)
    with pytest.raises(ValueError, match=r"another observation: column .* 'mu_s'"):
        check_environment(trained, gym.make("slipgym/LinearSlip-v0", engine="planar"))
    env.close()


def test_the_viewer_shows_no_estimate():
    with pytest.raises(ValueError, match=REFUSED):
        Session("linear_slip", engine="planar", estimator=None)
    session = Session("linear_slip", "constant_force", engine="planar", estimator=None)
    session.advance(0.1)
    assert 'data-name="mu_c estimated">no estimator<' in status(session)
    gui = Gui()
    Plots(gui, session)
    assert "nothing is estimated" in gui.pages[0].content
    assert "#D55E00" not in SurfacePlot().draw(session.env.simulation, session.info)
    session.env.close()
