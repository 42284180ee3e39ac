"""An exception at any moment of a call leaves an environment as it was, or one that asks for a reset."""

import numpy as np
import pytest

from tests.envs.interrupts import after_engine, before_engine, count, interrupt, lines

OTHER = {"object_size": (0.44, 0.02, 0.3)}
IDLE = np.zeros(1, np.float32)
MOMENTS = 25
TILT = {"physics": {"tilt": True}}
PLACES = {"before_engine": before_engine, "after_engine": after_engine, "lines": lines}


def said(env, seed=2, options=None) -> list[str]:
    """What an episode says, bit for bit."""
    return [
        repr(env.reset(seed=seed, options=options)),
        *(repr(env.step(np.float32([0.2 - 0.2 * k]))) for k in range(3)),
    ]


def moments(total: int) -> list[int]:
    """Some of so many moments, always the same."""
    most = min(total, MOMENTS)
    return sorted((np.random.default_rng(0).choice(total, most, replace=False) + 1).tolist())


def stepped(env, action) -> str:
    """What a step says; empty if the environment asks for a reset."""
    try:
        return repr(env.step(action))
    except RuntimeError as error:
        return "" if "call reset() before step()" in str(error) else repr(error)


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("config", [None, TILT], ids=["upright", "tilt"])
def test_a_reset_that_builds_another_box(make, place, config):
    env, fresh = make(config=config), make(config=config)
    expected = {name: said(fresh, options=options) for name, options in (("same", None), ("other", OTHER))}
    place = PLACES[place]
    env.reset(seed=0)
    untouched = repr(env.step(IDLE))
    total = count(place, lambda: env.reset(seed=1, options=OTHER))
    for at in moments(total):
        env.reset(seed=0)
        assert interrupt(place, at, lambda: env.reset(seed=1, options=OTHER))
        assert stepped(env, IDLE) in ("", untouched)
        name, options = (("same", None), ("other", OTHER))[at % 2]
        assert said(env, options=options) == expected[name], at


@pytest.mark.parametrize(
    ("engine", "place"), [("bullet", "after_engine"), ("bullet", "lines"), ("planar", "lines")]
)
def test_a_step(make, engine, place):
    env, place = make(engine=engine, frame_skip=2), PLACES[place]
    expected = said(make(engine=engine, frame_skip=2))
    env.reset(seed=0)
    untouched, after = (repr(env.step(IDLE)) for _ in range(2))
    for at in moments(count(place, lambda: env.step(IDLE))):
        env.reset(seed=0)
        assert interrupt(place, at, lambda: env.step(IDLE))
        assert stepped(env, IDLE) in ("", untouched, after)
        assert said(env) == expected, at


@pytest.mark.parametrize("engine", ["bullet", "planar"])
def test_a_reset_without_a_seed_happens_or_does_not(make, engine):
    env = make(engine=engine, randomization="train")
    env.reset(seed=5)
    expected, later = (repr(env.reset()) for _ in range(2))
    env.reset(seed=5)
    total = count(lines, env.reset)
    for at in (*moments(total), total):
        env.reset(seed=5)
        assert interrupt(lines, at, env.reset)
        assert repr(env.reset()) == (expected if at < total else later), at


@pytest.mark.parametrize("engine", ["bullet", "planar"])
def test_a_refused_option_changes_nothing(make, engine):
    env, twin = make(engine=engine), make(engine=engine)
    for each in (env, twin):
        each.reset(seed=5)
    with pytest.raises(ValueError, match="unknown option"):
        env.reset(seed=9, options={"mass": 1.0})
    assert repr(env.step(np.float32([0.5]))) == repr(twin.step(np.float32([0.5])))
    with pytest.raises(ValueError, match="must be at least mu_c"):
        env.reset(seed=9, options={"mu_s": 0.1, "mu_c": 0.5})
    assert repr(env.reset()) == repr(twin.reset())


@pytest.mark.parametrize("engine", ["bullet", "planar"])
def test_a_state_that_is_restored(make, engine):
    source, env = make(engine=engine), make(engine=engine)
    source.reset(seed=3, options=OTHER)
    state = source.get_state()
    expected = said(make(engine=engine))
    env.reset(seed=0)
    for at in moments(count(lines, lambda: env.set_state(state))):
        env.reset(seed=0)
        assert interrupt(lines, at, lambda: env.set_state(state))
        assert said(env) == expected, at
    env.set_state(state)
    assert repr(env.step(np.float32([0.5]))) == repr(source.step(np.float32([0.5])))


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_a_step_of_a_batch(make_vec, mode):
    env, fresh = (make_vec(num_envs=3, autoreset_mode=mode, history=1) for _ in range(2))
    actions = np.zeros((3, 1), np.float32)

    def played(batch):
        return repr((batch.reset(seed=2), batch.step(actions), batch.step(actions)))

    def begin():
        """A batch whose first episode ends in the step after next."""
        env.reset(seed=0)
        env.simulation.episode["step"][0] = env.simulation.episode["steps"][0] - 1
        if mode == "NextStep":
            env.step(actions)

    expected = played(fresh)
    begin()
    untouched, after = (repr(env.step(actions)) for _ in range(2))
    begin()
    for at in moments(count(lines, lambda: env.step(actions))):
        begin()
        assert interrupt(lines, at, lambda: env.step(actions))
        assert stepped(env, actions) in ("", untouched, after)
        assert played(env) == expected, at
