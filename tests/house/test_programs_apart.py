"""Programs that were compiled in different processes give the same bits as programs of one process."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
STEP = """
import hashlib
import warnings

warnings.simplefilter("error")
import gymnasium as gym
import numpy as np
from slipgym.config.load import names
from slipgym.config.physics import ContactModel
from slipgym.registration import TASK_MODULES
from typing import get_args

wanted = [(name, {}) for name in TASK_MODULES]
for contact in get_args(ContactModel):
    for sensors in names("sensors"):
        options = {"contact": contact, "sensors": sensors, "randomization": "lab"}
        wanted.append(("slipgym/LinearSlip-v0", options))
for name, options in wanted:
    envs = gym.make_vec(name, num_envs=2, **options)
    observation, _ = envs.reset(seed=3)
    middle = ((envs.action_space.low + envs.action_space.high) / 4).astype(np.float32)
    digest = hashlib.sha256(observation.tobytes())
    for _ in range(60):
        observation, reward, *_ = envs.step(middle)
        digest.update(observation.tobytes() + reward.tobytes())
    print(name, digest.hexdigest())
    envs.close()
"""


@pytest.mark.slow
def test_bits_do_not_depend_on_the_process_that_compiled(tmp_path):
    """Every process compiles a fourth of the programs, and numbers its functions anew."""

    def step() -> str:
        variables = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
        done = subprocess.run(
            [sys.executable, "-c", STEP], env=variables, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    together = step()
    programs = sorted(tmp_path.rglob("*.nbc"))
    assert len(programs) > 40
    for part in range(4):
        for path in programs[part::4]:
            path.unlink()
        assert step() == together
        assert sorted(tmp_path.rglob("*.nbc")) == programs
    assert step() == together
