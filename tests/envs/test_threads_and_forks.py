"""Environments in threads and in a fork of the process say what they say alone."""

import os
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest


def said(env) -> str:
    """What an episode says, bit for bit."""
    action = np.zeros(env.action_space.shape, np.float32)
    with np.printoptions(floatmode="unique", threshold=10_000):  # a thread has print options of its own
        return repr([env.reset(seed=2), *(env.step(action) for _ in range(3))])


def test_in_threads(make):
    expected = said(make(engine="planar"))
    envs = [make(engine="planar") for _ in range(4)]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(said, envs)) == [expected] * 4


@pytest.mark.skipif(sys.platform == "win32", reason="it cannot fork")
@pytest.mark.filterwarnings("ignore:.*multi-threaded.*fork:DeprecationWarning")
@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_in_a_fork(make, engine):
    env = make(engine=engine)
    expected = said(env)
    child = os.fork()
    if child == 0:
        equal = False
        try:
            equal = said(env) == expected
        finally:
            os._exit(0 if equal else 1)
    _, status = os.waitpid(child, 0)
    assert status == 0
    assert said(env) == expected
