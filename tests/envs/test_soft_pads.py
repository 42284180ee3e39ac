"""Pads of rubber in an environment: what an episode draws, what is published as true, rows of a batch."""

import gymnasium as gym
import numpy as np
import pytest

from slipgym.config import load, load_randomization
from slipgym.config.pad import EFFECTS
from slipgym.contact.soft_pad import load_pad, present_friction

LINEAR = "slipgym/LinearSlip-v0"


@pytest.mark.parametrize("preset", ["lab", "eval_ood"])
def test_presets_draw_what_the_rubber_does(preset):
    ranges = load_randomization(preset)
    for name in EFFECTS:
        low, high = getattr(ranges, name).ends
        assert high > low
    train = load_randomization("train")
    assert all(getattr(train, name) is None for name in EFFECTS)


@pytest.mark.parametrize("exponent", [-0.41, 0.51, float("nan")])
def test_an_exponent_out_of_range_is_refused_with_the_range(exponent):
    with pytest.raises(ValueError, match=r"contact\.pad\.load_exponent = .* >= -0\.4 and <= 0\.5"):
        load({"contact": {"pad": {"load_exponent": exponent}}})
    for allowed in (-0.4, 0.5):
        assert load({"contact": {"pad": {"load_exponent": allowed}}}).contact.pad.load_exponent == allowed


@pytest.mark.parametrize("preset", ["lab", "eval_ood"])
def test_friction_may_fall_or_rise_with_the_load(preset):
    """Both silicones of the data set lie within the range: -0.23 and 0.38 (docs/physics.md)."""
    low, high = load_randomization(preset).load_exponent.ends
    assert -0.4 <= low < -0.23
    assert 0.38 <= high <= 0.5
    env = gym.make(f"slipgym:{LINEAR}", randomization=preset, engine="planar", disable_env_checker=True)
    drawn = [env.reset(seed=seed)[1]["drawn"]["load_exponent"] for seed in range(60)]
    env.close()
    assert low <= min(drawn) < low + 0.1 * (high - low)
    assert high - 0.1 * (high - low) < max(drawn) <= high


def test_the_range_of_the_exponent_changes_no_other_value():
    ranges = load_randomization("lab").model_dump(exclude_none=True)
    found = []
    for ends in ([-0.25, 0.38], [0.1, 0.35]):
        choice = {**ranges, "load_exponent": {"uniform": ends}}
        env = gym.make(f"slipgym:{LINEAR}", randomization=choice, engine="planar", disable_env_checker=True)
        found.append(env.reset(seed=5)[1]["drawn"])
        env.close()
    assert found[0].pop("load_exponent") != found[1].pop("load_exponent")
    assert found[0] == found[1]


def test_true_friction_of_pads_that_hold_better_under_load():
    config = {"contact": {"pad": {"load_exponent": -0.2, "reference_force": 5.0}}}
    env = gym.make(f"slipgym:{LINEAR}", config=config, engine="planar", disable_env_checker=True)
    env.reset(seed=0, options={"mu_c": 0.4, "mu_s": 0.5, "initial_force": 10.0})
    for _ in range(120):
        *_, info = env.step(np.array([0.0], dtype=np.float32))
    ratio = float(env.unwrapped.simulation.plant.pads["normal"][0, 0]) / 5.0
    assert ratio > 2.0
    assert info["true"][:2] == pytest.approx([0.5 * ratio**0.2, 0.4 * ratio**0.2], rel=1e-4)
    env.close()


def test_an_episode_has_the_pads_that_it_drew():
    env = gym.make(f"slipgym:{LINEAR}", randomization="lab", engine="planar", disable_env_checker=True)
    _, info = env.reset(seed=3)
    pads = env.unwrapped.simulation.plant.pads[0]
    drawn = info["drawn"]
    for name in ("load_exponent", "radius_exponent", "cop_lever", "creep", "aging"):
        assert pads[name] == pytest.approx(drawn[name])
    assert pads["compliance"] == pytest.approx(drawn["shear_compliance"])
    assert pads["axes"][0] == pytest.approx([1.0 + drawn["anisotropy"], 1.0 - drawn["anisotropy"]])
    env.reset(seed=3, options={"randomization_scale": 0.0})
    assert pads["load_exponent"] == pytest.approx(0.0)
    assert pads["axes"] == pytest.approx(1.0)
    env.close()


def test_true_friction_is_that_of_the_present_load():
    pad = {"load_exponent": 0.3, "radius_exponent": 0.2, "reference_force": 5.0}
    config = {"contact": {"pad": pad}}
    env = gym.make(f"slipgym:{LINEAR}", config=config, engine="planar", disable_env_checker=True)
    env.reset(seed=0, options={"mu_c": 0.4, "mu_s": 0.5, "r": 0.006, "initial_force": 10.0})
    for _ in range(120):
        *_, info = env.step(np.array([0.0], dtype=np.float32))
    ratio = float(env.unwrapped.simulation.plant.pads["normal"][0, 0]) / 5.0
    assert ratio > 2.0
    expected = [0.5 * ratio**-0.3, 0.4 * ratio**-0.3, 0.006 * ratio**0.2]
    assert info["true"] == pytest.approx(expected, rel=1e-4)
    env.close()


def test_rows_of_a_batch_have_pads_of_their_own():
    arguments = {"randomization": "lab", "disable_env_checker": True}
    batch = gym.make_vec(f"slipgym:{LINEAR}", num_envs=3, randomization="lab")
    singles = [gym.make(f"slipgym:{LINEAR}", engine="planar", **arguments) for _ in range(3)]
    rows, _ = batch.reset(seed=7)
    alone = [env.reset(seed=7 + i)[0] for i, env in enumerate(singles)]
    np.testing.assert_array_equal(rows, np.stack(alone))
    for t in range(60):
        force = np.full((3, 1), 0.1 * np.sin(t / 5.0), dtype=np.float32)
        rows, rewards, *_ = batch.step(force)
        for i, env in enumerate(singles):
            row, reward, *_ = env.step(force[i])
            np.testing.assert_array_equal(rows[i], row)
            assert rewards[i] == reward
    batch.close()
    for env in singles:
        env.close()


def test_fields_that_came_later_move_no_draw():
    ranges, found = load_randomization("lab").model_dump(exclude_none=True), []
    later = ("speed_slope", "stiction")
    for choice in (ranges, {name: value for name, value in ranges.items() if name not in later}):
        env = gym.make(f"slipgym:{LINEAR}", randomization=choice, engine="planar", disable_env_checker=True)
        found.append(env.reset(seed=5)[1]["drawn"])
        env.close()
    drawn = [found[0].pop(name) for name in later]
    assert 0.0 not in drawn
    assert found[0] == found[1]


AREA = {"friction_by_area": True, "radius_exponent": {"uniform": [0.25, 0.333]}}


def strengths(pad: np.void, loads: np.ndarray) -> np.ndarray:
    """Friction mu_c N over the area of a contact whose radius is c N^b (Xydas & Kao), relative to 5 N."""
    pad, found = pad.copy(), []
    for normal in loads.tolist():
        load_pad(pad, normal)
        _, mu_c, radius = present_friction(pad)
        growth = (normal / 5.0) ** pad["radius_exponent"].item()
        if growth < 1.0:  # beyond it the pad's edge may be the limit
            assert radius == pytest.approx(pad["r"] * growth, rel=1e-5)
        found.append(mu_c / pad["mu_c"] * normal / 5.0 / growth**2)
    return np.array(found)


def test_exponents_tied_by_the_area_keep_the_shear_strength():
    """Free exponents do not: 1 - n - 2 b is then anything."""
    loads, seen = np.array([0.3, 1.0, 4.0, 5.0, 11.0, 25.0]), []
    env = gym.make(f"slipgym:{LINEAR}", randomization=AREA, engine="planar", disable_env_checker=True)
    for seed in range(20):
        drawn = env.reset(seed=seed)[1]["drawn"]
        seen.append((drawn["radius_exponent"], drawn["load_exponent"]))
        pad = env.unwrapped.simulation.plant.pads[0, 0]
        assert pad["load_exponent"] == pytest.approx(drawn["load_exponent"])
        np.testing.assert_allclose(strengths(pad, loads), 1.0, rtol=1e-5)
    env.close()
    radius, load_exponent = np.array(seen).T
    np.testing.assert_allclose(load_exponent, 1.0 - 2.0 * radius, rtol=1e-14)
    assert np.ptp(radius) > 0.06
    pad["load_exponent"] = 0.1
    assert abs(strengths(pad, loads) - 1.0).max() > 0.3


@pytest.mark.parametrize("radius_exponent", [0.0, 0.3])
def test_tied_exponents_begin_at_the_configured_pad(radius_exponent):
    """At scale s a fraction s of the way from the configuration to the pad drawn at scale 1."""
    first = {"radius_exponent": radius_exponent, "load_exponent": 0.2}
    arguments = {"config": {"contact": {"pad": first}}, "randomization": AREA, "engine": "planar"}
    with pytest.warns(UserWarning, match="has no effect") as warned:
        env = gym.make(f"slipgym:{LINEAR}", disable_env_checker=True, **arguments)
    given = " ".join(str(each.message) for each in warned)
    assert all(f"contact.pad.{name} has no effect" in given for name in first)
    found = []
    for scale in (0.0, 0.3, 1.0):
        drawn = env.reset(seed=4, options={"randomization_scale": scale})[1]["drawn"]
        found.append((drawn["radius_exponent"], drawn["load_exponent"]))
    env.close()
    start, between, end = np.array(found)
    np.testing.assert_allclose(start, (radius_exponent, 0.2), atol=1e-15)
    np.testing.assert_allclose(between, 0.7 * start + 0.3 * end, rtol=1e-14)
    assert end[1] == pytest.approx(1.0 - 2.0 * end[0], rel=1e-14)
