"""Arguments, options and configurations may be numpy's."""

import gymnasium as gym
import numpy as np
import pytest

from slipgym.config.level import load_level
from slipgym.config.load import load, load_randomization
from slipgym.tasks import find

HOLD = "slipgym/Hold-v0"
MAKE = {
    "scalar": lambda **more: gym.make(HOLD, engine="planar", **more).unwrapped,
    "vector": lambda **more: gym.make_vec(HOLD, num_envs=2, **more),
}
NUMPY = {
    "history": np.int16(2),
    "friction_source": np.str_("true"),
    "material": np.array("wood"),
    "sensors": np.str_("ideal"),
    "estimator": {"name": np.str_("disc"), "mu_c0": np.float32(0.25)},
    "randomization": {"mass_scale": {"uniform": np.array([0.9, 1.1], np.float32)}},
    "level": {"settings": {"grip_limit": np.float32(1.5)}},
    "config": {
        "physics": {"tilt": np.False_, "engine_steps": np.int64(2)},
        "object": {"size": np.array([0.4, 0.02, 0.26])},
        "tasks": {"hold": {"duration": np.float16(2.0)}},
    },
}


@pytest.mark.parametrize("name", NUMPY)
@pytest.mark.parametrize("kind", MAKE)
def test_arguments_may_be_numpy(kind, name):
    given = NUMPY[name]
    expected = given.tolist() if isinstance(given, np.ndarray | np.generic) else _python(given)
    with_numpy, without = MAKE[kind](**{name: given}), MAKE[kind](**{name: expected})
    assert with_numpy.reset(seed=0)[0].tolist() == without.reset(seed=0)[0].tolist()
    with_numpy.set_state(without.get_state())
    with_numpy.spec.to_json()


def _python(values):
    if isinstance(values, dict):
        return {str(key): _python(value) for key, value in values.items()}
    return values.tolist() if isinstance(values, np.ndarray | np.generic) else values


def test_seeds_and_reset_options_may_be_numpy():
    options = {
        "duration": np.float32(2.0),
        "object_size": np.array([0.4, 0.02, 0.26]),
        "finger_friction": [np.float64(1.0), np.int64(1)],
        "material": np.str_("wood"),
    }
    plain_options = _python(options) | {"finger_friction": [1.0, 1]}
    env = MAKE["scalar"]()
    expected = env.reset(seed=3, options=plain_options)[0]
    for seed in (np.int64(3), np.array(3), np.uint8(3)):
        np.testing.assert_array_equal(env.reset(seed=seed, options=options)[0], expected)
    envs = MAKE["vector"]()
    for seed in (np.int64(3), np.array([3, 4]), [np.int32(3), 4], np.array(3)):
        np.testing.assert_array_equal(envs.reset(seed=seed, options=options)[0][0], expected)
    rows = np.array([options, None], dtype=object)
    np.testing.assert_array_equal(envs.reset(seed=3, options={"rows": rows})[0][0], expected)


def test_loaders_take_numpy():
    assert load({"physics": {"engine_steps": np.int64(3)}}).physics.engine_steps == 3
    chosen = load_level({"settings": {"grip_limit": np.float32(1.5)}}, "hold")
    assert chosen.argument == {"settings": {"grip_limit": 1.5}}
    ranges = load_randomization({"lag": {"choices": np.array([0.01, 0.02])}})
    assert ranges.lag is not None
    assert ranges.lag.choices == (0.01, 0.02)
    assert find("Hold").options.parse({"duration": np.int64(2)}).duration == 2.0


@pytest.mark.parametrize(
    "arguments",
    [
        {"frame_skip": np.float64(2.0)},
        {"frame_skip": np.True_},
        {"history": np.array([1, 2])},
        {"level": {"settings": {"grip_limit": np.array([1.0, 2.0])}}},
        {"level": {"settings": {"grip_limit": np.datetime64("2020-01-01")}}},
        {"level": {"settings": {"grip_limit": np.float32("nan")}}},
        {"level": {"settings": {"grip_limit": 1j}}},
        {"level": {"settings": {"object": object()}}},
        {"config": {"tasks": {"hold": {"duration": np.complex64(1.0)}}}},
        {"randomization": {"lag": {"uniform": np.array([0.1])}}},
        {"randomization": {"lag": {"choices": [np.bool_(True)]}}},
        {"estimator": {"name": "rls", "mu_c0": np.array([1, 2])}},
        {"estimator": {"name": np.int64(3)}},
        {"material": np.array(["wood", "steel"])},
    ],
)
@pytest.mark.parametrize("kind", MAKE)
def test_numpy_that_does_not_fit_is_one_value_error(kind, arguments):
    with pytest.raises(ValueError, match="mu_c0|" + next(iter(arguments))) as caught:
        MAKE[kind](**arguments)
    assert type(caught.value) is ValueError
