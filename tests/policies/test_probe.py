"""The probe of the holding controller: what it finds, what it costs, and when it leaves the object alone."""

from types import SimpleNamespace
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import policies
from policies.controllers.base import Columns
from policies.controllers.exploration import DEVIATION, RATIO, ActiveExploration, ExplorationState
from policies.controllers.hold import HoldPolicy
from policies.controllers.slip_memory import SlipMemory
from policies.evaluation.play import play_episodes
from slipgym.envs import HoldEnv

CALM = {"shake_amplitude": 0.0, "shake_pitch": 0.0, "poke_impulse": [0.0, 0.0], "duration": 1.0}


def play(env, policy, seed=0, **options):
    """The last info, and columns over time."""
    observation, info = env.reset(seed=seed, options=options)
    state, over, rows = None, False, []
    while not over:
        action, state = policy.predict(observation, state=state)
        observation, _, terminated, truncated, info = env.step(action)
        support, mu_c = (observation[policy.index[name]] for name in ("confidence_mu_c", "mu_c"))
        slips = state[0, 2]
        rows.append((support, mu_c, np.mean(info["grip_force"]), np.hypot(*info["slip"][:2]), slips))
        over = terminated or truncated
    return info, SimpleNamespace(
        **dict(zip(("support", "mu_c", "force", "slip", "slips"), np.array(rows).T, strict=True))
    )


@pytest.mark.parametrize("mass", [0.15, 0.4])
@pytest.mark.parametrize("mu_c", [0.3, 0.6])
def test_it_finds_friction_and_holds_on_it(mu_c, mass):
    """Without noise, at rest: in half a second, with a tenth of the tolerance for each slip that it took."""
    env = HoldEnv(sensors="ideal", friction_source="estimated")
    policy = HoldPolicy()
    _, seen = play(env, policy, **CALM, mu_c=mu_c, mu_s=1.35 * mu_c, object_mass=mass)
    env.close()
    assert (seen.support[:60] > 0.0).any()
    assert seen.mu_c[-1] == pytest.approx(mu_c, rel=0.05)
    assert 1 <= seen.slips[-1] <= 3
    assert seen.slip[-1] < 2e-4 * seen.slips[-1]
    assert seen.force[-1] == pytest.approx((0.5 * mass * 9.81 + policy.gains.reserve) / mu_c, rel=0.06)


def test_the_rocking_halves_the_slip():
    """Against a smooth ramp that is as fast; squared, as the reward counts it, at many phases of sampling."""
    squares = []
    for probe in (ActiveExploration(), ActiveExploration(low=0.999, high=1.001)):
        env = HoldEnv(sensors="ideal", friction_source="estimated")
        slips = []
        for k in range(8):
            mass = 0.2 * 1.02**k
            slips.append(play(env, HoldPolicy(exploration=probe), **CALM, object_mass=mass)[1].slip[-1])
        env.close()
        squares.append(np.mean(np.square(slips)))
    assert squares[0] < 0.5 * squares[1]


@pytest.mark.parametrize("source", ["true", "nominal"])
def test_told_friction_it_does_not_probe(source):
    env = HoldEnv(friction_source=source)
    grips = [
        play(env, HoldPolicy(exploration=probe), duration=1.0)[1].force
        for probe in (ActiveExploration(), None)
    ]
    env.close()
    np.testing.assert_array_equal(*grips)


def test_without_a_probe_an_object_at_rest_stays_so():
    env = HoldEnv(friction_source="estimated")
    _, seen = play(env, HoldPolicy(exploration=None), **CALM)
    env.close()
    assert seen.slip.max() < 1e-6
    assert seen.support.max() == 0.0


def test_it_gives_up_where_nothing_is_learnt():
    """Each slip is caught by the largest command; after the last the grip is the cautious one."""
    policy = HoldPolicy(exploration=ActiveExploration(slips=2))
    state, commands = policy.initial_state(1), []
    for k in range(120):
        speed = 0.01 if k % 20 == 19 else 0.0
        command, state = policy.control(columns(policy, f_y=1.0, v_y=speed), state)
        commands.append(command[0])
    assert sum(command == policy.config.gripper.force_max for command in commands) == 2
    assert commands[-2] == pytest.approx((1.0 + policy.gains.reserve) / policy.prior.mu_c)


def test_what_the_smallest_grip_holds_is_probed_no_further():
    """Nothing slips and no estimator learns; the load that held shows how much friction there is at least."""
    env = HoldEnv(friction_source="estimated")
    policy = HoldPolicy()
    _, seen = play(env, policy, **CALM, mu_c=0.7, mu_s=1.0, object_mass=0.1)
    env.close()
    assert seen.slip.max() < 1e-6
    assert seen.force.min() < 0.7
    held = 0.05 * 9.81 / seen.force.min()
    wanted = (0.05 * 9.81 + policy.gains.reserve) * RATIO / held
    assert seen.force[-1] == pytest.approx(wanted, rel=0.1)
    assert seen.force[-1] < 0.6 * (0.05 * 9.81 + policy.gains.reserve) / policy.prior.mu_c


def columns(policy, **of_both):
    row = np.zeros((1, policy.index["confidence_r"] + 1))
    for name, value in of_both.items():
        for finger in (1, 2):
            row[0, policy.index[f"{name}_{finger}"]] = value
    return Columns(row, policy.index)


def test_a_fall_of_the_load_is_a_slip_and_a_rise_is_none():
    policy = HoldPolicy()
    for change, caught in ((0.8, True), (0.95, False), (1.3, False)):
        state = policy.initial_state(1)
        for _ in range(5):
            _, state = policy.control(columns(policy, f_y=2.0), state)
        command, _ = policy.control(columns(policy, f_y=2.0 * change), state)
        assert (command[0] == policy.config.gripper.force_max) == caught


def explored(held, known=True, deviation=0.25, least=0.0):
    """Friction by an estimate of 0.5 with a deviation, or without an estimate, and by what held."""
    shown: Any = {"mu_c": 0.5, "sd_mu_c": deviation, "confidence_mu_c": 0.02 * known}
    shown = {name: np.array([value]) for name, value in shown.items()}
    state = ExplorationState(*np.zeros((5, 1)))._replace(held=np.array([held]))
    return state.corrected(np.array([0.5]), shown, least)[0]


def test_what_held_counts_with_the_weight_of_its_variance():
    weight = 0.5**2 / (0.5**2 + DEVIATION**2)
    assert explored(0.26) == pytest.approx(0.5 ** (1.0 - weight) * 0.2**weight)
    assert explored(0.0) == explored(0.26, deviation=0.0) == 0.5


def test_without_an_estimate_what_held_counts_from_the_least_on():
    assert explored(0.26, known=False) == pytest.approx(0.2)
    assert explored(0.0, known=False) == explored(0.26, known=False, least=0.5) == 0.5
    assert explored(1.3, known=False, least=0.5) == pytest.approx(1.0)


def test_a_grip_that_hardly_touches_shows_nothing():
    state = ExplorationState(*np.zeros((5, 3)))
    seen = state.holding(np.ones(3), np.array([0.1, 2.0, 2.0]), np.array([True, True, False]))
    np.testing.assert_array_equal(seen.held, [0.0, 0.5, 0.0])
    np.testing.assert_array_equal(
        seen.holding(np.ones(3), np.full(3, 4.0), np.ones(3, bool)).held, [0.25, 0.5, 0.25]
    )


def test_memory_goes_by_rows():
    policy = HoldPolicy()
    keywords = {"num_envs": 4, "friction_source": "estimated", "randomization": "train", "threads": 1}
    envs = gym.make_vec("slipgym:slipgym/Hold-v0", **keywords)
    observations, _ = envs.reset(seed=0)
    state: Any = None
    alone: list[Any] = [None] * 4
    for k in range(60):
        starts = np.array([False, k == 30, False, False])
        actions, state = policy.predict(observations, state, starts)
        for i in range(4):
            own = None if starts[i] else alone[i]
            action, alone[i] = policy.predict(observations[i], own)
            np.testing.assert_array_equal(actions[i], action)
        observations = envs.step(actions)[0]
    envs.close()


@pytest.mark.slow
def test_the_probe_saves_most_of_the_force_that_the_truth_saves():
    """Random objects, noisy sensors of unknown latency; at the same success, with the paper's estimator.

    "disc" knows only the latency of the preset: where that is wrong its mu_c is too low, the grip too firm.
    """
    grips = {}
    for name, source, probe in (
        ("none", "estimated", None),
        ("probe", "estimated", ActiveExploration()),
        ("true", "true", ActiveExploration()),
    ):
        env = HoldEnv(friction_source=source, randomization="train", estimator="rls")
        played = [play(env, HoldPolicy(exploration=probe), seed, duration=2.0) for seed in range(6)]
        env.close()
        assert all(info["is_success"] for info, _ in played)
        grips[name] = np.mean([seen.force for _, seen in played])
    assert grips["none"] - grips["probe"] > 0.75 * (grips["none"] - grips["true"]) > 0.5


@pytest.mark.parametrize(
    "bad",
    [{"keep": 1.0}, {"low": 0.0}, {"high": 1.0}, {"catch": 0.5}, {"smoothing": 1.5}, {"slips": 0}],
)
def test_bad_values_are_named(bad):
    with pytest.raises(ValueError, match=next(iter(bad))):
        ActiveExploration(**bad)


def test_a_light_object_that_the_smallest_grip_holds_lets_go_in_hinge():
    """The exploration finds no slip, so no estimator learns: without what held none of these is solved."""
    policy = policies.make("hinge")
    options = [{"mu_c": 0.95, "mu_s": 1.2, "object_mass": mass} for mass in np.linspace(0.1, 0.12, 8)]
    arguments = {**policies.modes(policy), "friction_source": "estimated", "level": "hard"}
    assert play_episodes("hinge", policy, arguments, range(8), options).success.all()


def test_a_slippery_object_does_not_fall_in_hinge_without_estimates():
    """The memory of slips acts on what held alone, which is less than the assumed friction here."""
    policy = SlipMemory("hinge")
    options = [{"mu_c": mu_c, "mu_s": 1.2 * mu_c} for mu_c in np.linspace(0.15, 0.2, 8)]
    arguments = {**policies.modes(policy), "friction_source": "none", "level": "standard"}
    assert not play_episodes("hinge", policy, arguments, range(8), options).dropped.any()
