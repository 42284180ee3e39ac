"""Values at the ends of what the configuration allows: finite steps, and a warning where they are slow."""

import warnings

import numpy as np
import pytest

from slipgym.config import Config, load
from slipgym.config.load import merge
from slipgym.envs.setup import SLOW, work

IDLE = np.zeros(1, np.float32)


def ends(model=Config) -> dict[str, list[float]]:
    """Dotted key -> smallest and largest value of every number of the configuration that has both."""
    schema = model.model_json_schema()

    def walk(node, path):
        if "$ref" in node:
            node = {**schema["$defs"][node["$ref"].rpartition("/")[2]]}
        for option in node.get("anyOf", ()):
            yield from walk(option, path)
        for key, child in node.get("properties", {}).items():
            yield from walk(child, f"{path}.{key}" if path else key)
        if "minimum" in node and "maximum" in node and node.get("type") in ("number", "integer"):
            yield path, [node["minimum"], node["maximum"]]

    return dict(walk(schema, ""))


def nested(key: str, value: float) -> dict:
    *groups, last = key.split(".")
    values = {last: value}
    for group in reversed(groups):
        values = {group: values}
    return values


ENDS = ends()
COMPANIONS = {
    "physics.control_rate": "sensors.slip.rate",
    "sensors.slip.rate": "physics.control_rate",
}
"""Keys that must be equal."""
COMPILED_APART = {"sensors.force_torque.mode_frequency"}
"""Keys whose ends compile programs of their own."""


def test_every_number_has_both_ends():
    numbers = set()

    def walk(values, path):
        for key, value in values.items():
            if isinstance(value, dict) and key != "materials":
                walk(value, f"{path}{key}.")
            elif isinstance(value, float | int) and not isinstance(value, bool):
                numbers.add(f"{path}{key}")

    walk(load().model_dump(), "")
    open_ended = numbers - set(ENDS)
    assert open_ended <= {"contact.pad.shear_compliance", "sensors.slip.latency_samples",
                          "sensors.slip.latency_spread", "contact.pad.anisotropy",
                          "contact.normal_stiffness"}, open_ended  # fmt: skip


@pytest.mark.parametrize("end", [0, 1], ids=["least", "most"])
@pytest.mark.parametrize(
    "key", [pytest.param(key, marks=[pytest.mark.slow] * (key in COMPILED_APART)) for key in ENDS]
)
def test_an_end_is_refused_or_finite(make, key, end):
    if "materials" in key:
        pytest.skip("a name is needed")
    value = ENDS[key][end]
    config = nested(key, value)
    if key in COMPANIONS:
        config = merge(config, nested(COMPANIONS[key], value))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        try:
            env = make(engine="planar", config=config)
            env.reset(seed=0)
        except ValueError:  # it contradicts another value
            return
        for _ in range(3):
            observation, reward, *_ = env.step(IDLE)
    assert np.isfinite(observation).all()
    assert np.isfinite(reward)


@pytest.mark.slow  # it compiles for a sensor with more samples
def test_slow_steps_are_warned_of(make):
    default = work(load())
    for config, frame_skip in (
        ({"physics": {"substep_max": 1e-5, "engine_steps": 100, "solver_iterations": 1000}}, 1),
        ({}, 1000),
    ):
        assert work(load(config), frame_skip) > SLOW * default
        with pytest.warns(UserWarning, match="times as long as with the defaults"):
            make(engine="planar", config=config, frame_skip=frame_skip)
    make(engine="planar", contact="distributed")
    make(engine="planar", frame_skip=12)


def test_arguments_have_an_upper_end(make, make_vec):
    for arguments, message in (
        ({"frame_skip": 10_001}, "frame_skip = 10001 must be a whole number from 1 to 10000"),
        ({"history": 1001}, "history = 1001 must be a whole number from 0 to 1000"),
    ):
        with pytest.raises(ValueError, match=message):
            make(engine="planar", **arguments)
    with pytest.raises(ValueError, match="num_envs = 1048577 must be a whole number from 1 to 1048576"):
        make_vec(num_envs=2**20 + 1)
