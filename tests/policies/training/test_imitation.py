"""A learner that begins as a controller does."""

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
import policies
from policies.training import model as learners
from policies.training import vector
from policies.training.imitation import imitate


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
