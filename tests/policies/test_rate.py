"""Policies are compared at the same rate of action."""

import numpy as np
import pytest

from policies.evaluation import experiment as model
from policies.evaluation.experiment import Experiment
from policies.evaluation.plan import plan
from policies.evaluation.play import play_episodes
from policies.evaluation.trial import environment, make_policy, run_trial
from policies.policy_leaderboard.entries import constants, strongest
from slipgym.config.yaml_model import validate


def experiment(*names, **changes):
    values = {
        "name": "rates",
        "task": "RotationalSlip",
        "trials": 2,
        "engine": "planar",
        "policies": [{"name": name} for name in names],
        "friction": [{"source": "true"}],
        "options": {"duration": 0.2, "settle": 0.05, "hold": 0.05},
    }
    return validate({**values, **changes}, Experiment, "test")


def test_a_controller_acts_as_often_as_the_learned_policy_beside_it():
    alone = experiment("rotational_slip")
    beside = experiment("rotational_slip", "rotational_slip_scratch")
    assert (alone.steps_per_action, beside.steps_per_action) == (1, 2)
    for trial in plan(beside):
        assert environment(beside, trial)["frame_skip"] == 2
    trial = plan(beside)[0]
    assert make_policy(beside, trial).config.physics.control_rate == 60
    assert make_policy(alone, plan(alone)[0]).config.physics.control_rate == 120
    steps = {run_trial(beside, each).row["steps"] for each in plan(beside)}
    assert len(steps) == 1


def test_different_rates_are_refused(monkeypatch):
    with pytest.raises(ValueError, match=r"same rate.*rotational_slip_scratch 2.*asked for: 1"):
        experiment("rotational_slip_scratch", frame_skip=1)
    assert model.common_frame_skip(["hold", "constant_force"]) == 1
    monkeypatch.setattr(model, "frame_skip_of", {"a": 1, "b": 2}.get)
    with pytest.raises(ValueError, match="same rate of action only"):
        model.common_frame_skip(["a", "b"])


def test_constant_grips_run_in_the_episodes_of_the_experiment():
    each = experiment(
        "constant_force", task="Hold", options={"duration": 0.5}, trials=3, randomization="train"
    )
    seeds, options = [trial.seed for trial in plan(each)], [dict(each.options)] * 3
    members = constants(each.environment_config().gripper, 4)
    arguments = {**each.arguments, **members[0].arguments}
    weak, *_, firm = (play_episodes("Hold", one.policy, arguments, seeds, options) for one in members)
    assert weak.dropped.all()
    assert firm.success.all()
    assert strongest("Hold", members, each.arguments, seeds) is not members[0]
    choice = {"name": "constant_force", "parameters": {"force": members[-1].policy.force}}
    same = validate({**dict(each), "policies": [choice]}, Experiment, "test")
    rewards = [run_trial(same, trial).row["return"] for trial in plan(same)]
    np.testing.assert_allclose(firm.reward, rewards, rtol=1e-6)
