"""The one file of LeRobot's EnvHub makes what LeRobot expects."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from gymnasium.vector import SyncVectorEnv

FILE = Path(__file__).resolve().parents[2] / "examples" / "lerobot" / "env.py"


@pytest.fixture(scope="module")
def module():
    spec = importlib.util.spec_from_file_location("hub_env", FILE)
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


def test_it_makes_every_task_and_an_episode_ends_as_lerobot_reads_it(module, monkeypatch):
    assert len(module.TASKS) == 9
    monkeypatch.setattr(module, "TASKS", ("slipgym/Hold-v0", "slipgym/LinearSlip-v0"))
    suites = module.make_env(n_envs=2, use_async_envs=False)
    assert {suite: list(tasks) for suite, tasks in suites.items()} == {"slipgym": [0, 1]}
    envs, other = suites["slipgym"].values()
    other.close()
    assert isinstance(envs, SyncVectorEnv)
    observation, _ = envs.reset(seed=[0, 1])
    assert observation["agent_pos"].shape == (2, *envs.single_observation_space["agent_pos"].shape)
    limit = envs.call("_max_episode_steps")[0]
    assert envs.call("task_description")[0] == "slipgym/Hold-v0"
    assert envs.unwrapped.metadata["render_fps"] > 0
    assert envs.call("render")[0].ndim == 3
    for _ in range(limit):
        observation, _, terminated, truncated, infos = envs.step(
            np.zeros(envs.action_space.shape, np.float32)
        )
        if (terminated | truncated).all():
            break
    assert (terminated | truncated).all()
    assert "is_success" in infos["final_info"]
    envs.close()


def test_no_environments_are_refused(module):
    with pytest.raises(ValueError, match="n_envs = 0"):
        module.make_env(n_envs=0)
