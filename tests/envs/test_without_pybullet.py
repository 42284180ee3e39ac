"""Without PyBullet the planar engine works, and the engine "bullet" says what to install."""

import subprocess
import sys

PROGRAM = """
import sys

class Nowhere:
    def find_spec(self, name, path=None, target=None):
        if name == "pybullet":
            raise ModuleNotFoundError("No module named 'pybullet'", name="pybullet")

sys.meta_path.insert(0, Nowhere())
import gymnasium as gym
import slipgym

env = gym.make("slipgym/Hold-v0", engine="planar")
env.reset(seed=0)
print(env.step(env.action_space.sample())[0].shape)
envs = gym.make_vec("slipgym/Hold-v0", num_envs=2)
print(envs.reset(seed=0)[0].shape)
try:
    gym.make("slipgym/Hold-v0", engine="bullet")
except ModuleNotFoundError as error:
    print(error.name, error)
"""


def test_all_but_the_engine_bullet_works():
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True)
    one, several, refused = done.stdout.splitlines()
    assert several == f"(2, {one.strip('(,)')})"
    assert refused.startswith("pybullet engine='bullet' needs PyBullet")
    assert "pip install 'slipgym[bullet]'" in refused
    assert "engine='planar'" in refused
