"""An estimator of one's own in the environments, where nothing has compiled it before."""

import importlib
import re
import sys

import gymnasium as gym
import numpy as np
import pytest

from estimator.estimate import ESTIMATE
from tests.extending.conftest import ROOT

PAGE = (ROOT / "docs" / "adding_an_estimator.md").read_text(encoding="utf-8")
SOURCE = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)[0]
FAULTS = """
def plain(states, parameters, t, wrenches, twists, estimates):
    pass

@njit
def unknown_field(states, parameters, t, wrenches, twists, estimates):
    states[0].nothere = 1.0

@njit("void(int64)")
def with_signature(x):
    pass

@njit
def wrong_type(states, parameters, t, wrenches, twists, estimates):
    states[0].t = t + "abc"

@njit
def three_arguments(states, parameters, t):
    pass

PLAIN, UNKNOWN_FIELD, WITH_SIGNATURE, WRONG_TYPE, THREE_ARGUMENTS = (
    Specification(f"ratios:{function.__name__.upper()}", RatioParameters, initial_states, function)
    for function in (plain, unknown_field, with_signature, wrong_type, three_arguments)
)
"""


@pytest.fixture
def ratios(tmp_path, monkeypatch):
    """The page's module, fresh, with faulty estimators as well."""
    (tmp_path / "ratios.py").write_text(SOURCE + FAULTS, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    yield importlib.import_module("ratios")
    del sys.modules["ratios"]


def _final(engine):
    env = gym.make("slipgym:slipgym/LinearSlip-v0", estimator="ratios:SPECIFICATION", engine=engine)
    env.reset(seed=0, options={"material": "wood"})
    for _ in range(120):
        *_, info = env.step(np.array([-0.9], np.float32))
    return info["estimated_per_finger"]


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_the_environments_compile_it(ratios, engine):
    assert not ratios.update_batch.overloads
    assert not np.array_equal(_final(engine)[0], [0.5, 0.4, 0.01])  # it learned something


def test_a_batch_compiles_it(ratios):
    envs = gym.make_vec("slipgym:slipgym/LinearSlip-v0", num_envs=2, estimator="ratios:SPECIFICATION")
    assert np.isfinite(envs.reset(seed=0)[0]).all()


def test_a_program_for_other_arrays_is_not_taken_for_its_own(ratios):
    parameters = ratios.RatioParameters().as_array()
    states, estimates = ratios.initial_states(np.repeat(parameters, 4)), np.zeros(4, ESTIMATE)
    ratios.update_batch(states[::2], parameters, 0, np.zeros((2, 4)), np.zeros((2, 3)), estimates[::2])
    found = _final("planar")
    ratios.update_batch.recompile()
    assert np.array_equal(_final("planar"), found)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("PLAIN", "a function of numba.njit"),
        ("UNKNOWN_FIELD", "no array has a field 'nothere'"),
        ("WITH_SIGNATURE", "without a signature of its own"),
        ("WRONG_TYPE", r"ratios\.py:\d+: No implementation"),
        ("THREE_ARGUMENTS", "function takes 3 arguments"),
    ],
)
def test_what_does_not_compile_is_refused_in_a_line(ratios, name, said):
    with pytest.raises(ValueError, match=f"estimator 'ratios:{name}'.*{said}") as raised:
        gym.make("slipgym:slipgym/LinearSlip-v0", estimator=f"ratios:{name}", engine="planar")
    assert "\n" not in str(raised.value)
