"""Physics clients that somebody else disconnects, or whose number another client takes."""

import numpy as np
import pybullet
import pytest

IDLE = np.zeros(1, np.float32)
CALLS = {
    "step": lambda env: env.step(IDLE),
    "reset": lambda env: env.reset(seed=1),
    "rebuild": lambda env: env.reset(options={"object_size": (0.44, 0.02, 0.3)}),
    "get_state": lambda env: env.get_state(),
}


def number_of(env) -> int:
    return env.simulation.world.client


@pytest.fixture
def taken():
    """Disconnects the client of an environment and lets another one have its number."""
    others = []

    def take(env) -> int:
        number = number_of(env)
        pybullet.disconnect(number)
        others.append(pybullet.connect(pybullet.DIRECT))
        assert others == [number]
        for _ in range(3):
            body = pybullet.createMultiBody(1.0, physicsClientId=number)
            pybullet.addUserData(body, "slipgym", "0", physicsClientId=number)
        return number

    yield take
    for other in others:
        pybullet.disconnect(other)


@pytest.mark.parametrize("call", CALLS)
def test_a_disconnected_client_is_named(make, call):
    env = make()
    env.reset(seed=0)
    pybullet.disconnect(number_of(env))
    for _ in range(2):
        with pytest.raises(RuntimeError, match=r"physics client .* is gone|call reset\(\)"):
            CALLS[call](env)
    env.close()
    env.close()


@pytest.mark.parametrize("call", CALLS)
def test_a_client_with_the_same_number_is_left_alone(make, taken, call):
    env = make()
    env.reset(seed=0)
    number = taken(env)
    with pytest.raises(RuntimeError, match=r"physics client .* is gone"):
        CALLS[call](env)
    env.close()
    del env
    assert pybullet.isConnected(number)
    assert pybullet.getNumBodies(number) == 3


def test_a_client_that_is_taken_before_the_first_reset_is_left_alone(make, taken):
    env = make()
    number = taken(env)
    with pytest.raises(RuntimeError, match=r"physics client .* is gone"):
        env.reset(seed=0)
    env.close()
    assert pybullet.getNumBodies(number) == 3


def test_a_state_is_not_restored_into_the_client_of_another(make, taken):
    source, env = make(), make()
    source.reset(seed=0)
    state = source.get_state()
    env.reset(seed=0)
    number = taken(env)
    with pytest.raises(RuntimeError, match=r"physics client .* is gone"):
        env.set_state(state)
    assert pybullet.getNumBodies(number) == 3


def test_environments_side_by_side_have_marks_of_their_own(make):
    first, second = make(), make()
    for env in (first, second):
        env.reset(seed=0)
    pybullet.disconnect(number_of(first))
    third = make()
    third.reset(seed=0)
    assert number_of(third) == number_of(first)
    with pytest.raises(RuntimeError, match=r"physics client .* is gone"):
        first.step(IDLE)
    first.close()
    for env in (second, third):
        env.step(IDLE)
