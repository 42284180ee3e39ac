"""A learner that changes a controller's actions."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
import yaml

pytest.importorskip("stable_baselines3")
import policies
from policies.learned import LearnedPolicy
from policies.training import files, folder, run, vector
from policies.training import model as learners

RESIDUAL = {"controller": "linear_slip_continuous", "reach": 0.2}


def controlled(config, envs, controller, steps):
    """Observations of a run of a controller by itself, one (n, m) per step, and the actions."""
    observations, state, starts = envs.reset(), None, np.ones(envs.num_envs, bool)
    for _ in range(steps):
        actions, state = controller.predict(observations, state, starts)
        yield observations, actions, state
        observations, _, starts, _ = envs.step(actions)


def test_without_a_change_the_controller_acts(small):
    config = small(residual=RESIDUAL, engine_threads=1)
    slower = {"physics": {"control_rate": 30}, "sensors": {"slip": {"rate": 30}}}
    controller = policies.make("linear_slip_continuous", config=slower)
    envs, alone = vector.make(config, 3, 4), vector.make(small(engine_threads=1), 3, 4)
    found, ends = envs.reset(), 0
    for observations, actions, state in controlled(config, alone, controller, 40):
        wanted = np.concatenate([observations, actions, state], axis=1, dtype=np.float32)
        assert np.array_equal(found, wanted)
        found, _, dones, _ = envs.step(np.zeros((4, 1), np.float32))
        ends += dones.sum()
    assert ends >= 8


def test_a_change_is_added_up_to_the_reach(small):
    envs, inner = vector.make(small(residual=RESIDUAL, engine_threads=1), 3, 2), []
    envs.reset()
    envs.venv.step_async = lambda actions: inner.append(actions)
    given = envs._given.copy()
    envs.step_async(np.array([[0.5], [-1.0]], np.float32))
    assert inner[0] == pytest.approx(np.clip(given + np.array([[0.1], [-0.2]]), -1.0, 1.0))


def test_an_episodes_last_observation_goes_with_what_the_controller_would_do(small):
    config = small(residual=RESIDUAL, engine_threads=1)
    controller = policies.make(
        "linear_slip_continuous", config={"physics": {"control_rate": 30}, "sensors": {"slip": {"rate": 30}}}
    )
    envs = vector.make(config, 3, 2)
    seen, state, starts = envs.reset(), None, np.ones(2, bool)
    width, ends = seen.shape[1] - 3, 0
    for _ in range(30):
        _, state = controller.predict(seen[:, :width], state, starts)
        seen, _, starts, infos = envs.step(np.zeros((2, 1), np.float32))
        for i in np.flatnonzero(starts):
            last = infos[i]["terminal_observation"]
            both = np.array([last[:width]] * 2)
            actions, memory = controller.predict(both, state, np.zeros(2, bool))
            assert np.array_equal(last[width:], np.append(actions[i], memory[i]).astype(np.float32))
            ends += 1
    assert ends >= 2


@pytest.mark.parametrize("source", ["estimated", "none"])
def test_the_file_acts_as_the_learner(small, tmp_path, source):
    environment = {**small().environment.model_dump(), "friction_source": source, "history": 1}
    config = small(residual=RESIDUAL, engine_threads=1, environment=environment, task="LinearSlip")
    folder.begin(tmp_path / "run", config, 3)
    run.train(tmp_path / "run", progress=False)
    policy = policies.load(tmp_path / "run" / "policy")
    assert isinstance(policy, LearnedPolicy)
    residual = policy.description.residual
    assert residual is not None
    assert (residual.controller, residual.reach, residual.memory) == ("linear_slip_continuous", 0.2, 2)
    model = learners.make(config, learners.normalised(config, vector.make(config, 0), training=False), 3)
    from policies.training import checkpoint_io, checkpoints

    best = checkpoint_io.read(checkpoints.best(tmp_path / "run"))["learner"]
    learners.set_parameters(model, best)
    learners.set_normalisation(model.get_vec_normalize_env(), best["normalisation"])
    inner = vector.make(config.model_copy(update={"residual": None}), 0)
    outer = vector.make(config, 0)
    seen, bare, state = outer.reset(), inner.reset(), None
    starts = np.ones(config.num_envs, bool)
    for _ in range(30):
        actions, state = policy.predict(bare, state, starts)
        change, _ = model.predict(model.get_vec_normalize_env().normalize_obs(seen), deterministic=True)
        bare, _, starts, _ = inner.step(actions)
        seen, _, ends, _ = outer.step(change)
        assert np.array_equal(starts, ends)
        # float32 in another order moves an action by 1e-6 at most, and what is then felt by as little
        assert np.allclose(seen[:, : bare.shape[1]], bare, atol=1e-3)


def test_a_crafted_file_is_refused(small, tmp_path, monkeypatch):
    folder.begin(tmp_path / "run", small(residual=RESIDUAL, budget=32), 3)
    run.train(tmp_path / "run", progress=False)
    file = tmp_path / "run" / "policy" / "policy.json"
    for key, value, match in (
        ("memory", 3, r"is float64 \(33,\), policy.json needs float64 \(34,\)"),
        ("controller", "os:system", "unknown controller 'os:system'"),
        ("parameters", {"k_x": "rm"}, "parameters.k_x"),
        ("reach", 0.0, "reach"),
    ):
        values = json.loads(file.read_text())
        values["residual"][key] = value
        file.with_name("policy.json").write_text(json.dumps(values))
        with pytest.raises(ValueError, match=match):
            policies.load(file.parent)
        values["residual"] = {**RESIDUAL, "parameters": {}, "memory": 2}
        file.write_text(json.dumps(values))
    policies.load(file.parent)
    monkeypatch.setattr(
        policies.find("linear_slip_continuous"), "initial_state", lambda _, n: np.zeros((n, 5))
    )
    with pytest.raises(ValueError, match="had 2 numbers in training, in this version of slipgym it has 5"):
        policies.load(file.parent)


def test_the_example_of_the_page_is_a_configuration():
    page = (Path(__file__).parents[3] / "docs" / "training.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```yaml\n(.*?residual.*?)```", page, re.DOTALL)
    config = files.checked(yaml.safe_load(example), "docs/training.md")
    assert config.residual is not None
    assert files.checked(yaml.safe_load(files.text(config)), "again") == config


def test_what_does_not_fit_is_refused(small):
    with pytest.raises(ValueError, match="is not for LinearSlip"):
        small(residual={"controller": "hold", "reach": 0.1})
    with pytest.raises(ValueError, match="unknown controller 'nobody'"):
        small(residual={"controller": "nobody", "reach": 0.1})
    with pytest.raises(ValueError, match="needs action_mode 'grip_force'"):
        small(residual=RESIDUAL, environment={"action_mode": "grip_force_wrist"})
    with pytest.raises(ValueError, match="observation_mode"):
        small(residual=RESIDUAL, environment={"observation_mode": "sensor"})
