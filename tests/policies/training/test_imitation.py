"""A learner that begins as a controller does."""

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
import policies
from policies.base import ForcePolicy
from policies.training import folder, run, vector
from policies.training import model as learners
from policies.training.imitation import _led, imitate


@pytest.mark.parametrize("source", ["estimated", "none"])
def test_it_acts_like_the_controller(small, source):
    tasks = {"linear_slip": {"duration": 0.2, "settle": 0.1, "hold": 0.1}}
    config = small(
        imitation={
            "policy": "constant_force",
            "rounds": 2,
            "steps": 20,
            "epochs": 150,
            "learning_rate": 0.01,
        },
        environment={
            "randomization": "none",
            "history": 1,
            "friction_source": source,
            "config": {"tasks": tasks},
        },
        num_envs=8,
        engine_threads=1,
    )
    envs = learners.normalised(config, vector.make(config, 0), training=False)
    model = learners.make(config, envs, 0)
    wanted, _ = policies.make("constant_force").predict(np.zeros(40, np.float32))
    before = np.abs(model.predict(envs.reset(), deterministic=True)[0] - wanted).max()
    imitate(config, model, 0)
    after = np.abs(model.predict(envs.reset(), deterministic=True)[0] - wanted).max()
    assert after < 0.1 < 0.5 < before
    assert envs.obs_rms.count > 300.0
    envs.close()


class Pulse(ForcePolicy):
    """Grips hard in every third step: what it does next is not in an observation."""

    def initial_state(self, n):
        return np.zeros((n, 1))

    def control(self, columns, state):
        return np.where(state[:, 0] % 3 == 2, 20.0, 10.0), state + 1.0


def test_a_learner_with_a_memory_acts_like_a_controller_with_one(small):
    config = small(
        algorithm="recurrent_ppo",
        imitation={
            "policy": f"{__name__}:Pulse",
            "rounds": 4,
            "steps": 30,
            "epochs": 20,
            "learning_rate": 0.01,
            "learning_rate_end": 0.1,
            "huber": 0.1,
            "max_grad_norm": 1.0,
            "hand_over": "within",
            "spread": "deviation",
            "sequences": 8,
            "chunk": 7,
        },
        recurrent_ppo={"lstm_hidden_size": 16, "memory_span": 8, "net_arch": [16]},
        num_envs=8,
        engine_threads=1,
    )
    envs = learners.normalised(config, vector.make(config, 0), training=False)
    model = learners.make(config, envs, 0)
    imitate(config, model, 0)
    teacher, starts, told, done, memory, state = Pulse(), np.ones(8, bool), [], [], None, None
    observations = envs.venv.reset()
    for _ in range(20):  # beyond the end of the first episode
        wanted, state = teacher.predict(observations, state, starts)
        actions, memory = model.predict(envs.normalize_obs(observations), memory, starts, deterministic=True)
        told.append(wanted)
        done.append(actions)
        observations, _, starts, _ = envs.venv.step(actions)
    assert np.abs(np.array(done) - np.array(told)).mean() < 0.1 < np.std(told)
    envs.close()


def test_controller_and_learner_share_a_round(small):
    for hand_over, first in (("between", [10, 10, 0, 0]), ("within", [1.25, 3.75, 6.25, 8.75])):
        chosen = small(imitation={"policy": "linear_slip", "steps": 10, "hand_over": hand_over}).imitation
        np.testing.assert_allclose(_led(chosen, 0.5, 4), first)
        np.testing.assert_allclose(_led(chosen, 1.0, 4), 10)
        np.testing.assert_allclose(_led(chosen, 0.0, 4), 0)


def test_a_gate_that_remembers_long_does(small):
    config = small(algorithm="recurrent_ppo", recurrent_ppo={"lstm_hidden_size": 64, "memory_span": 50})
    model = learners.make(config, learners.normalised(config, vector.make(config, 0)), 0)
    lstm = model.policy.lstm_actor
    bias = (lstm.bias_ih_l0 + lstm.bias_hh_l0).detach().numpy()
    kept = 1.0 + np.exp(bias[64:128])  # 1 / (1 - sigmoid)
    assert 2.0 <= kept.min() < 6.0 < 40.0 < kept.max() <= 50.0
    assert not bias[128:].any()


def test_a_run_may_be_imitation_alone(small, tmp_path):
    chosen = {"policy": "linear_slip", "rounds": 2, "steps": 12, "epochs": 1}
    folder.begin(tmp_path / "run", small(budget=0, algorithm="recurrent_ppo", imitation=chosen), 0)
    result = run.train(tmp_path / "run", progress=False)
    assert (result["ended"], result["steps"], result["best"]["steps"]) == ("budget", 0, 0)
    policy = policies.load(tmp_path / "run" / "policy")
    assert policy.description.network.kind == "lstm"


def test_a_controller_of_another_action_mode_is_refused(small):
    config = small(imitation={"policy": "planar_slip"}, engine_threads=1)
    model = learners.make(config, learners.normalised(config, vector.make(config, 0)), 0)
    with pytest.raises(ValueError, match="PlanarSlip"):
        imitate(config, model, 0)


def test_only_ppo_can_begin_so(small):
    with pytest.raises(ValueError, match="imitation"):
        small(imitation={"policy": "linear_slip"}, algorithm="sac")
    with pytest.raises(ValueError, match="linear_slop"):
        small(imitation={"policy": "linear_slop"})
    with pytest.raises(ValueError, match="budget = 0"):
        small(budget=0)
    with pytest.raises(ValueError, match="'kv'"):
        small(imitation={"policy": "linear_slip", "parameters": {"kv": 1.0}})
