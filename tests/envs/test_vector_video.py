"""Gymnasium's RecordVideo records a vector environment."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.wrappers.vector import RecordVideo

ID = "slipgym/LinearSlip-v0"


@pytest.mark.quick_cases("range")
@pytest.mark.parametrize(
    "chosen", [{}, {"render_rows": [0, 1]}, {"render_rows": range(2)}], ids=["all", "list", "range"]
)
def test_a_short_video(tmp_path, chosen):
    pytest.importorskip("moviepy")
    envs = gym.make_vec(ID, num_envs=2, render_mode="rgb_array", threads=1, **chosen)
    envs = RecordVideo(envs, str(tmp_path / "video"), video_length=4, step_trigger=lambda step: step == 0)
    envs.reset(seed=0)
    for _ in range(6):
        envs.step(np.zeros((2, 1), np.float32))
    envs.close()
    (video,) = (tmp_path / "video").glob("*step-0.mp4")
    assert video.stat().st_size > 1000


@pytest.mark.parametrize(("n", "shown"), [(3, 3), (16, 16), (17, 1)])
def test_a_few_environments_are_all_shown(n, shown):
    envs = gym.make_vec(ID, num_envs=n, render_mode="rgb_array", threads=1)
    envs.reset(seed=0)
    assert len(envs.render()) == shown
    envs.close()
