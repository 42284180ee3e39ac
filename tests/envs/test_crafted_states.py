"""States that no environment wrote are refused before compiled code reads them."""

import copy
import dataclasses

import numpy as np
import pytest

from slipgym.envs.state_checks import RULES

IDLE = np.zeros(1, np.float32)
HUGE = 2**62
DAMAGED = r"damaged|unknown bit generator"
ARRAYS = ("estimator_states", "estimates", "episode")


@pytest.fixture(params=["bullet", "planar"])
def engine(request) -> str:
    return request.param


@pytest.fixture
def midway(make, engine):
    env = make(engine=engine, history=1)
    env.reset(seed=4)
    for _ in range(5):
        env.step(IDLE)
    return env


def records(simulation) -> dict[str, np.ndarray]:
    """The arrays of records of a simulation's state, by name."""
    names = [field.name for field in dataclasses.fields(simulation.plant)]
    found = {name: getattr(simulation.plant, name) for name in names}
    found |= {name: simulation.arrays[name] for name in ARRAYS}
    return {name: array for name, array in found.items() if array is not None and array.dtype.names}


def with_parts(state, path, value):
    """A copy of a state with another value at a path of attributes."""
    *owners, last = path.split(".")
    return _replaced(state, owners, last, value)


def _replaced(owner, names, last, value):
    if not names:
        return dataclasses.replace(owner, **{last: value})
    inner = _replaced(getattr(owner, names[0]), names[1:], last, value)
    return dataclasses.replace(owner, **{names[0]: inner})


def refusal(env, state) -> str:
    """The message with which a state is refused; empty if it is not."""
    try:
        env.set_state(state)
    except ValueError as error:
        return str(error)
    return ""


def test_every_whole_number_has_a_rule(midway):
    """A new field has a range, or is listed as fixed or free."""
    found = records(midway.get_state().simulation)
    for name, rules in RULES.items():
        if name in found:
            names = set(found[name].dtype.names)
            assert set(rules.fixed) | set(rules.ranges) | set(rules.free) <= names, name
    assert {"world", "pads", "fingers", "force_torque", "slip_sensors", "episode"} <= set(RULES)


def test_whole_numbers_out_of_range_are_refused_or_harmless(midway):
    refused = set()
    for name in records(midway.get_state().simulation):
        for key in records(midway.get_state().simulation)[name].dtype.names:
            state = midway.get_state()
            array = records(state.simulation)[name]
            if array.dtype[key].base.kind not in "iu":
                continue
            for value in (-HUGE, -1, 2**33, HUGE) if array.dtype[key].base.kind == "i" else (2**64 - 1,):
                state = midway.get_state()
                records(state.simulation)[name][key] = value
                if refusal(midway, state):
                    refused.add(f"{name}.{key}")
                    continue
                try:
                    midway.step(IDLE)
                except FloatingPointError:
                    midway.reset()
    assert {"world.control_ticks", "fingers.queued", "force_torque.period", "slip_sensors.window"} <= refused
    assert {"estimator_states.buffer_next", "episode.pushes", "slip_sensors.taken", "world.tick"} <= refused


CRAFTED = {
    "no row": lambda array: array[:0],
    "rows for four": lambda array: np.repeat(array, 4, axis=0),
    "other numbers": lambda array: (
        array.astype(np.float32) if not array.dtype.names else array.view(np.uint8)
    ),
    "no array": lambda array: array.tolist(),
    "objects": lambda array: np.full(array.shape, None, dtype=object),
    "read only": lambda array: np.broadcast_to(array[:1, ...], array.shape)[..., :0],
}


@pytest.mark.parametrize("craft", CRAFTED)
def test_arrays_of_another_kind(midway, craft):
    expected = repr(copy.deepcopy(midway).step(IDLE))
    names = [*midway.get_state().simulation.arrays]
    for name in names:
        state = midway.get_state()
        state.simulation.arrays[name] = CRAFTED[craft](state.simulation.arrays[name])
        with pytest.raises(ValueError, match="the state is damaged"):
            midway.set_state(state)
    for name in ("world", "pads", "fingers", "force_torque", "slip_sensors"):
        state = midway.get_state()
        setattr(state.simulation.plant, name, CRAFTED[craft](getattr(state.simulation.plant, name)))
        with pytest.raises(ValueError, match="the state is damaged"):
            midway.set_state(state)
    frames = with_parts(midway.get_state(), "frames", np.zeros((2, 2, 3), np.float32))
    with pytest.raises(ValueError, match="the state is damaged: frames"):
        midway.set_state(frames)
    assert repr(midway.step(IDLE)) == expected


NONSENSE = {
    "simulation": ({}, 3),
    "simulation.plant": (None, {}),
    "simulation.arrays": (None, {}, {"episode": 1}),
    "simulation.materials": ([], [3], ["kryptonite"], "x"),
    "simulation.boxes": ([], [None], ["box"]),
    "generator": (None, {}, {"bit_generator": "PCG64"}, {"bit_generator": "MT19937"}),
    "seed": ("0", 1.5),
    "made_of": (None, {}),
    "frames": (None, [], np.zeros(3)),
}


@pytest.mark.parametrize("path", NONSENSE)
def test_values_of_another_kind(midway, path):
    for value in NONSENSE[path]:
        state = with_parts(midway.get_state(), path, value)
        with pytest.raises(ValueError, match=DAMAGED):
            midway.set_state(state)
    midway.step(IDLE)


def test_numbers_that_are_not_finite(midway):
    for name in ("world", "pads", "fingers", "slip_sensors"):
        state = midway.get_state()
        array = getattr(state.simulation.plant, name)
        key = {"world": "com", "pads": "z", "fingers": "force", "slip_sensors": "moved"}[name]
        array[key] = np.nan
        with pytest.raises(ValueError, match=rf"plant\.{name}\.{key} holds a number that is not finite"):
            midway.set_state(state)


ENGINE = {
    "engine": (None,),
    "engine.engine": (None, b"", b"BULLETd-v326", b"x" * 100_000),
    "engine.box": (None,),
    "engine.box.size": (None, (0.1, 0.1), (0.0, 0.1, 0.1), (0.2, 0.2, 0.2), (np.inf, 0.1, 0.1)),
    "engine.box.mass": (0.0, -1.0, np.nan, "heavy"),
    "engine.reading": (None, (), ((), (), (), (), ()), 5 * ((0.0, 0.0, 0.0),)),
}


@pytest.mark.parametrize("path", ENGINE)
def test_the_part_of_pybullet(make, path):
    env = make()
    env.reset(seed=4)
    for value in ENGINE[path]:
        state = with_parts(env.get_state(), f"simulation.{path}", value)
        with pytest.raises(ValueError, match="damaged"):
            env.set_state(state)
        env.reset(seed=4)


@pytest.mark.parametrize("tries", [2, pytest.param(8, marks=pytest.mark.slow)])
def test_a_damaged_file_of_pybullet_does_not_crash(make, tries):
    env = make()
    env.reset(seed=4)
    whole = env.get_state().simulation.engine.engine
    rng, refused = np.random.default_rng(0), 0
    for k in range(tries):
        content = bytearray(whole if k % 2 else whole[: rng.integers(len(whole))])
        for at in rng.integers(len(content), size=3):
            content[at] ^= 1 << rng.integers(8)
        state = with_parts(env.get_state(), "simulation.engine.engine", bytes(content))
        refused += "PyBullet cannot restore" in refusal(env, state)
        env.reset(seed=4)
    assert refused >= tries // 2


def test_a_batch_refuses_them_too(make_vec):
    env = make_vec(num_envs=3)
    env.reset(seed=0)
    for name, value in (
        ("ready", np.ones(2, bool)),
        ("over", np.ones(3)),
        ("ready", np.full(3, 7, np.uint8).view(bool)),
        ("generators", []),
        ("generators", [{}] * 3),
        ("frames", np.zeros((3, 1, 1), np.float32)),
    ):
        with pytest.raises(ValueError, match=DAMAGED):
            env.set_state(with_parts(env.get_state(), name, value))
    state = env.get_state()
    state.simulation.plant.fingers["served"][1, 0] += 2
    with pytest.raises(ValueError, match="queued - served"):
        env.set_state(state)
    env.step(np.zeros((3, 1), np.float32))
