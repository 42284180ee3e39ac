"""A state that is damaged, of another version or of another environment is one ValueError."""

import dataclasses
import pickle

import numpy as np
import pytest

from slipgym.tasks import find
from slipgym.tasks.episode import EPISODE

IDLE = np.zeros(1, np.float32)


@pytest.fixture(params=["bullet", "planar"])
def midway(make, request):
    env = make(engine=request.param, history=1)
    env.reset(seed=4)
    for _ in range(5):
        env.step(IDLE)
    return env


@pytest.fixture
def batch(make_vec):
    env = make_vec(num_envs=3)
    env.reset(seed=0)
    return env


def with_parts(state, path, value):
    """A copy of a state with another value at a path of attributes."""
    owner, _, rest = path.partition(".")
    if rest:
        value = with_parts(getattr(state, owner), rest, value)
    return dataclasses.replace(state, **{owner: value})


def records(state) -> dict[str, np.ndarray]:
    """Arrays of a state by name."""
    plant = {f"plant.{name}": array for name, array in vars(state.simulation.plant).items()}
    found = plant | {f"arrays.{name}": array for name, array in state.simulation.arrays.items()}
    return {name: array for name, array in found.items() if array is not None and array.size}


def changed(array) -> None:
    """Change one number of an array: NaN, or one bit; in a record, its first field."""
    if array.dtype.names:
        changed(array[array.dtype.names[0]])
    elif array.dtype.kind == "f":
        array.flat[0] = np.nan
    else:
        array.flat[0] = array.flat[0] ^ 1


def test_a_change_of_any_array_is_named(midway):
    """Also of a field that is added some day."""
    before = repr(pickle.loads(pickle.dumps(midway)).step(IDLE))
    for name, array in records(midway.get_state()).items():
        for key in (array.dtype.names or ("",))[::5]:
            state = midway.get_state()
            given = records(state)[name]
            changed(given[key] if key else given)
            with pytest.raises(
                ValueError, match=rf"damaged: simulation\.{name}[.a-z_0-9]* (holds|is not as)"
            ):
                midway.set_state(state)
    assert repr(midway.step(IDLE)) == before


NONSENSE = {
    "simulation": ({}, 3),
    "simulation.plant": (None, {}),
    "simulation.arrays": (None, {}, {"episode": 1}),
    "simulation.materials": ([], [3], ["kryptonite"], "x"),
    "simulation.boxes": ([], [None], ["box"]),
    "generator": (None, {}, {"bit_generator": "PCG64"}),
    "seed": ("0", 1.5),
    "made_of": (None, {}),
    "frames": (None, [], np.zeros(3), np.full((1, 2, 3), None)),
    "sums": (3, {"frames": 0}),
}


@pytest.mark.parametrize("path", NONSENSE)
def test_values_of_another_kind(midway, path):
    for value in NONSENSE[path]:
        with pytest.raises(ValueError, match="the state is damaged"):
            midway.set_state(with_parts(midway.get_state(), path, value))
    midway.step(IDLE)


def test_a_state_of_another_version(midway):
    state = dataclasses.replace(midway.get_state(), version="0.0.1", sums={})
    with pytest.raises(ValueError, match=r"the state is of slipgym 0\.0\.1, this is"):
        midway.set_state(state)


def test_the_part_of_pybullet(make):
    env = make(engine="bullet")
    env.reset(seed=4)
    whole = env.get_state().simulation.engine.engine
    for content in (b"", whole[:-1], bytes([whole[0] ^ 1]) + whole[1:], None):
        with pytest.raises(ValueError, match=r"damaged: simulation\.engine\.engine"):
            env.set_state(with_parts(env.get_state(), "simulation.engine.engine", content))
    for path, value in (("box.mass", 0.0), ("reading", ())):
        with pytest.raises(ValueError, match=rf"damaged: simulation\.engine\.{path}"):
            env.set_state(with_parts(env.get_state(), f"simulation.engine.{path}", value))


def test_a_state_whose_layout_is_another(midway):
    """As after a change of the code, with checksums that fit."""
    state = midway.get_state()
    other = EPISODE.descr[1:]
    state.simulation.arrays["episode"] = np.zeros(1, other)
    state.simulation.arrays["wrenches"] = np.zeros((1, 2, 5))
    for names in (("episode", "wrenches"), ("wrenches",)):
        with pytest.raises(ValueError, match=rf"damaged: arrays\.{names[0]}.* has .*; the environment has"):
            midway.set_state(dataclasses.replace(state, sums={}))
        state.simulation.arrays["episode"] = midway.get_state().simulation.arrays["episode"]


def test_numbers_that_are_not_finite_do_not_travel(midway, batch):
    """A state with checksums that fit and NaN in it; rows without an episode do not count."""
    state = midway.get_state()
    state.simulation.plant.world["com"] = np.nan
    with pytest.raises(ValueError, match=r"plant\.world\.com holds a number that is not finite"):
        midway.set_state(dataclasses.replace(state, sums={}))
    state = batch.get_state()
    state.simulation.plant.fingers["force"][1] = np.nan
    ready = np.array([True, False, True])
    batch.set_state(dataclasses.replace(state, ready=ready, sums={}))
    with pytest.raises(ValueError, match=r"plant\.fingers\.force holds a number that is not finite"):
        batch.set_state(dataclasses.replace(state, sums={}))


def test_a_batch_refuses_them_too(batch):
    for name, value in (
        ("ready", np.ones(2, bool)),
        ("over", np.ones(3)),
        ("generators", []),
        ("frames", np.zeros((3, 1, 1), np.float32)),
    ):
        with pytest.raises(ValueError, match=f"the state is damaged: {name}"):
            batch.set_state(with_parts(batch.get_state(), name, value))
    state = batch.get_state()
    state.simulation.plant.fingers["served"][1, 0] += 2
    with pytest.raises(ValueError, match=r"plant\.fingers is not as get_state"):
        batch.set_state(state)
    batch.step(np.zeros((3, 1), np.float32))


def test_a_state_can_be_changed_on_purpose(midway):
    state = midway.get_state()
    assert find("LinearSlip").name == state.made_of["task"]
    state.simulation.arrays["episode"]["steps"] = 6
    midway.set_state(dataclasses.replace(state, sums={}))
    assert midway.step(IDLE)[3]
