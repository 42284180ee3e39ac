"""Learned policies meet environments, by path, by name and in experiments."""

import gymnasium as gym
import numpy as np
import pytest

import policies
import slipgym  # noqa: F401
from policies.evaluation.plan import plan
from policies.evaluation.trial import run_trial, run_trials
from policies.learned import LearnedPolicy, pretrained
from policies.learned.fitting import column_of
from slipgym.config import load
from slipgym.envs.observation import columns
from slipgym.tasks import TASKS


def refused(policy, message, task="Hold", **arguments):
    env = gym.make(f"slipgym/{task}-v0", **arguments)
    try:
        with pytest.raises(ValueError, match=message):
            policy.check(env)
    finally:
        env.close()


def test_an_environment_that_means_something_else_is_refused(policy_folder):
    policy = LearnedPolicy(policy_folder())
    refused(policy, r"column 23, 'mu_s' .* in training, is missing here", friction_source="none")
    refused(policy, r"another observation: column 18 is 'reference_position'", task="LinearSlip")
    refused(policy, r"another action: column 0 is 'force_increment'", action_mode="force_increment")
    refused(policy, r"another observation: column 23 is 'wrist_pitch'", action_mode="grip_force_wrist")
    refused(policy, r"history=0: 29 numbers; .* has 87", history=2)
    refused(policy, r"120 steps per second, here are 60", frame_skip=2)
    wider = {"gripper": {"force_max": 30.0}}
    refused(
        policy, r"\(0\.6 to 30, \[N\]\) here, 'grip_force' \(0\.6 to 25, \[N\]\) in training", config=wider
    )


@pytest.mark.parametrize("arguments", [{}, {"friction_source": "true"}, {"observation_mode": "dict"}])
def test_an_environment_with_the_same_columns_fits(policy_folder, arguments):
    policy = LearnedPolicy(policy_folder())
    env = gym.make("slipgym/Hold-v0", **arguments)
    policy.check(env)
    observation, _ = env.reset(seed=0)
    env.step(policy.predict(observation)[0])
    env.close()


def test_by_path_and_by_name_it_is_the_same(policy_folder, tmp_path, monkeypatch):
    before = set(policies.names()) - set(pretrained.folders())
    folder = policy_folder("shelf/hold_ppo")
    monkeypatch.setattr(pretrained, "FOLDER", tmp_path / "shelf")
    assert set(policies.names()) == {*before, "hold_ppo"}
    observation = np.linspace(-1.0, 1.0, 29, dtype=np.float32)
    wanted, _ = policies.load(folder).predict(observation)
    for policy in (policies.make("hold_ppo"), policies.load("hold_ppo"), policies.load(str(folder))):
        np.testing.assert_array_equal(policy.predict(observation)[0], wanted)
    with pytest.raises(ValueError, match=r"'hold_ppi'.*hold_ppo"):
        policies.make("hold_ppi")
    for which in ("hold_ppo", folder):
        with pytest.raises(ValueError, match=r"unknown parameter 'force'.*none, it is learned"):
            policies.load(which, force=1.0)


def test_an_experiment_runs_a_learned_policy_by_its_folder(small, policy_folder):
    arguments = {"action_mode": "force_increment", "history": 1, "observation_mode": "dict"}
    plain, given = policy_folder("plain", task="LinearSlip"), policy_folder("unlike", task="LinearSlip")
    description = LearnedPolicy(given).description.environment
    deep = policy_folder(
        "deep",
        task="LinearSlip",
        action_mode="force_increment",
        environment={
            "arguments": arguments,
            "history": 1,
            "observation": [c.model_dump() for c in description.observation],
        },
    )
    choices = [{"name": "constant_force"}, {"name": str(plain)}, {"name": str(deep), "label": "increments"}]
    experiment = small(
        policies=choices,
        materials=["wood"],
        trials=1,
        vary={"distance": [0.02]},
        config={"object": {"mass": 0.1}},
    )
    results = {result.row["policy"]: result for result in run_trials(experiment, plan(experiment), 1, False)}
    assert set(results) == {"constant_force", "plain", "increments"}
    for result in results.values():
        assert result.row["seed"] == results["plain"].row["seed"]
        assert result.row["final_error_mm"] == pytest.approx(
            result.series["slip_y"][-1] * -1e3 - 20.0, abs=1e-3
        )
    assert len({result.row["mean_force_N"] for result in results.values()}) == 3


def test_an_experiment_refuses_what_does_not_fit(small, policy_folder, tmp_path):
    hold = policy_folder("hold_policy")
    experiment = small(policies=[{"name": str(hold)}])
    with pytest.raises(
        ValueError, match=r"trained for another observation: column 18 is 'reference_position'"
    ):
        run_trial(experiment, plan(experiment)[0])
    with pytest.raises(ValueError, match=r"policies\.0: unknown policy 'nowhere'.*folder of a learned one"):
        small(policies=[{"name": "nowhere"}])
    with pytest.raises(ValueError, match=r"policies\.0: unknown parameter 'force'"):
        small(policies=[{"name": str(hold), "parameters": {"force": 1.0}}])
    (hold / "weights.safetensors").write_bytes(b"changed")
    with pytest.raises(ValueError, match=r"policies\.0: .*SHA-256"):
        small(policies=[{"name": str(hold)}])


def test_a_folder_does_not_shadow_a_name(small, policy_folder, tmp_path, monkeypatch):
    policy_folder("hold")
    monkeypatch.chdir(tmp_path)
    assert not isinstance(policies.load("hold"), LearnedPolicy)
    assert isinstance(policies.load("./hold"), LearnedPolicy)
    small(policies=[{"name": "hold", "parameters": {"reserve": 2.0}}])


def test_a_learned_policy_plays(policy_folder, tmp_path):
    from policies.play import watch

    folder = policy_folder(environment={"arguments": {"history": 1}, "history": 1})
    film, options = tmp_path / "film.gif", {"duration": 0.1}
    (outcome,) = watch("Hold", str(folder), film, options=options, progress=False)
    assert film.is_file()
    assert not outcome.dropped
    with pytest.raises(ValueError, match="trained for another observation"):
        watch("LinearSlip", str(folder), film, progress=False)
    needed = r"another observation: .*; it was trained with sensors='lab', friction_source='none'"
    with pytest.raises(ValueError, match=needed):
        watch("Hold", "hold_lab", film, progress=False, friction_source="true")


def test_load_knows_the_controllers_too():
    assert policies.load("constant_force", force=3.0).force == 3.0


def test_no_shipped_policy_takes_a_controllers_name():
    from policies.controllers.table import CLASSES

    assert not set(pretrained.folders()) & set(CLASSES)


def described():
    """Columns of Hold as policy.json has them."""
    return [column_of(column).model_dump() for column in columns(load(), TASKS["Hold"], "estimated")]


@pytest.mark.parametrize("history", [0, 2])
def test_a_policy_reads_its_columns_by_name_and_ignores_later_ones(policy_folder, history):
    """As one that was trained before the observation had `violated`."""
    observed = described()
    at = [column["name"] for column in observed].index("violated")
    old = {"observation": [*observed[:at], *observed[at + 1 :]], "history": history}
    old["arguments"] = {"friction_source": "estimated", "action_mode": "grip_force", "history": history}
    policy = LearnedPolicy(policy_folder(environment=old))
    assert (len(policy.names), policy.width) == (len(observed), (history + 1) * len(observed))
    env = gym.make("slipgym/Hold-v0", engine="planar", history=history)
    policy.check(env)
    observation, _ = env.reset(seed=0)
    other = observation.copy()
    other[at :: len(observed)] = 1.0
    np.testing.assert_array_equal(policy.predict(other)[0], policy.predict(observation)[0])
    frames = observation.reshape(history + 1, -1)
    wanted = np.delete(frames, at, axis=1).ravel()
    np.testing.assert_array_equal(np.take(observation, policy._read), wanted)
    env.close()


def test_a_column_that_is_gone_is_an_error(policy_folder):
    observed = described()
    gone = {"observation": [*observed, {**observed[-1], "name": "colour"}]}
    refused(
        LearnedPolicy(policy_folder(environment=gone)), r"column 29, 'colour' .* in training, is missing here"
    )
