"""A batch with infos of ends alone says the same as one with all infos, where it says something."""

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401

SHORT = {"tasks": {"linear_slip": {"duration": 0.2, "settle": 0.1, "hold": 0.1}}}


def batch(infos, mode):
    return gym.make_vec(
        "slipgym/LinearSlip-v0",
        4,
        "vector_entry_point",
        infos=infos,
        autoreset_mode=mode,
        threads=1,
        randomization="train",
        config=SHORT,
    )


def compare(told, infos, everyone):
    """Infos of rows where `told`, beside those of everyone; zeros and no marks elsewhere."""
    if not told.any():
        assert infos == {}
        return
    for name, values in infos.items():
        if name.startswith("_"):
            assert np.array_equal(values, told), name
        elif isinstance(values, dict):
            compare(told, values, everyone[name])
        else:
            assert np.array_equal(values[told], everyone[name][told]), name
            assert not values[~told].any(), name


@pytest.mark.parametrize("mode", ["SameStep", "NextStep", "Disabled"])
def test_ends_alone(mode):
    few, many = batch("ends", mode), batch("all", mode)
    begun, wanted = few.reset(seed=3)[1], many.reset(seed=3)[1]
    assert begun.keys() == wanted.keys()
    compare(np.ones(4, dtype=bool), begun, wanted)
    rng, over, ends = np.random.default_rng(0), np.zeros(4, dtype=bool), 0
    for _ in range(60):
        if mode == "Disabled" and over.any():
            for envs in (few, many):
                envs.reset(options={"reset_mask": over})
        actions = rng.uniform(-1, 0, (4, 1)).astype(np.float32)
        actions[0] = -1.0
        found, wanted = few.step(actions), many.step(actions)
        assert all(np.array_equal(a, b) for a, b in zip(found[:4], wanted[:4], strict=True))
        began = over if mode == "NextStep" else np.zeros(4, dtype=bool)
        over = found[2] | found[3]
        ends += over.sum()
        infos, everyone = found[4], wanted[4]
        if mode == "SameStep":
            assert ("final_info" in infos) == over.any()
            if over.any():
                compare(over, infos.pop("final_info"), everyone["final_info"])
        infos = {name: values for name, values in infos.items() if not name.endswith(("final_info", "obs"))}
        drawn = {name: infos.pop(name) for name in ("drawn", "_drawn") if name in infos}
        compare(over if mode == "SameStep" else began, drawn, everyone)
        compare(over | began, infos, everyone)
    assert ends > 3
    few.close()
    many.close()


def test_an_unknown_choice_is_refused():
    with pytest.raises(ValueError, match=r"infos.*'some'.*all, ends"):
        batch("some", "SameStep")
