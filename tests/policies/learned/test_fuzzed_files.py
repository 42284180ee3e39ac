"""Whatever is in the files: it is a policy, or a ValueError says what is wrong; nothing else happens."""

import hashlib
import json
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import policies
from policies.learned import files
from policies.learned.description import WEIGHTS

BUDGET = settings(
    max_examples=150,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
    derandomize=True,
)
LEAVES = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5)
VALUES = st.recursive(
    LEAVES,
    lambda v: st.lists(v, max_size=3) | st.dictionaries(st.text(max_size=5), v, max_size=3),
    max_leaves=5,
)


def outcome(description: bytes, weights: bytes) -> str:
    """What loading these two files and acting once comes to."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / files.DESCRIPTION).write_bytes(description)
        (Path(folder) / WEIGHTS).write_bytes(weights)
        try:
            policy = policies.load(folder)
            policy.predict(np.zeros(policy.description.environment.width, np.float32))
        except ValueError as error:
            return str(error)
        return ""


def places(values, path=()):
    """Every place in nested values."""
    inner = (
        values.items() if isinstance(values, dict) else enumerate(values) if isinstance(values, list) else ()
    )
    for key, value in inner:
        yield (*path, key)
        yield from places(value, (*path, key))


@pytest.fixture
def whole(policy_folder, lstm):
    folder = policy_folder(**lstm)
    return json.loads((folder / files.DESCRIPTION).read_text()), (folder / WEIGHTS).read_bytes()


@BUDGET
@given(data=st.data())
def test_any_value_anywhere_in_the_description(whole, data):
    values, weights = json.loads(json.dumps(whole[0])), whole[1]
    *path, last = data.draw(st.sampled_from(list(places(values))))
    at = values
    for key in path:
        at = at[key]
    at[last] = data.draw(VALUES)
    outcome(json.dumps(values).encode(), weights)


def test_every_key_but_the_optional_ones_is_needed(whole):
    needed, optional = 0, set()
    for *path, last in places(whole[0]):
        values = json.loads(json.dumps(whole[0]))
        at = values
        for key in path:
            at = at[key]
        if isinstance(last, str) and last.isidentifier():
            del at[last]
            told = outcome(json.dumps(values).encode(), whole[1])
            needed += bool(told)
            assert not told or last in told or "is missing" in told
            optional |= set() if told else {last}
    assert needed > 100
    assert optional == {"critic", "residual", "friction_source", "action_mode", "numpy"}


@BUDGET
@given(at=st.integers(0, 10**6), byte=st.integers(0, 255), cut=st.integers(0, 40))
def test_any_byte_anywhere_in_the_weights(whole, at, byte, cut):
    values, weights = json.loads(json.dumps(whole[0])), bytearray(whole[1])
    weights[at % len(weights)] = byte
    weights = bytes(weights[: len(weights) - cut])
    if weights != whole[1]:
        assert "SHA-256" in outcome(json.dumps(values).encode(), weights)
    values["files"][WEIGHTS] = hashlib.sha256(weights).hexdigest()
    told = outcome(json.dumps(values).encode(), weights)
    assert told == "" or WEIGHTS in told or "too large" in told
    assert not cut or "is no safetensors file" in told


@BUDGET
@given(text=st.binary(max_size=60))
def test_any_bytes_for_a_description(whole, text):
    assert files.DESCRIPTION in outcome(text, whole[1])
