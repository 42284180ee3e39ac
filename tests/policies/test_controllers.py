"""The classic controllers, closed loop and column by column."""

import numpy as np
import pytest

import policies
from policies.controllers.base import Columns, ObservationIndex
from policies.controllers.sensing import ConservativePrior
from policies.evaluation.play import play_episodes
from slipgym.config import load
from slipgym.envs import (
    CarryEnv,
    FragileHoldEnv,
    HingeEnv,
    HoldEnv,
    LinearSlipEnv,
    PivotToEnv,
    PlanarSlipEnv,
    RotationalSlipEnv,
)
from slipgym.tasks import find

SOURCES = ("estimated", "true", "nominal")
CONTROLLERS = [
    ("linear_slip", LinearSlipEnv),
    ("rotational_slip", RotationalSlipEnv),
    ("hinge", HingeEnv),
    ("planar_slip", PlanarSlipEnv),
    ("hold", HoldEnv),
    ("fragile_hold", FragileHoldEnv),
    ("carry", CarryEnv),
    ("pivot_to", PivotToEnv),
]


def play(env, policy, seed, **options):
    observation, info = env.reset(seed=seed, options=options)
    state, over, largest = None, False, 0.0
    while not over:
        action, state = policy.predict(observation, state=state)
        observation, _, terminated, truncated, info = env.step(action)
        largest = max(largest, np.hypot(*info["slip"][:2]))
        over = terminated or truncated
    return info, largest


@pytest.mark.quick_cases("0.02-2.0-true", "0.04-2.0-estimated", "0.04-5.0-nominal", "0.04-5.0-estimated")
@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize(("distance", "duration"), [(0.02, 2.0), (0.04, 2.0), (0.04, 5.0)])
def test_linear_slip_arrives(source, distance, duration):
    env = LinearSlipEnv(friction_source=source, material="cardboard")
    info, _ = play(env, policies.make("linear_slip"), 3, distance=distance, duration=duration)
    env.close()
    assert not info["dropped"]
    assert abs(-info["slip"][1] - distance) <= 2e-3
    assert info["is_success"]


@pytest.mark.parametrize("source", SOURCES)
def test_hold_holds(source):
    env, policy = HoldEnv(friction_source=source), policies.make("hold")
    for seed in range(3):
        info, largest = play(env, policy, seed, duration=4.0)
        assert not info["dropped"]
        assert largest < 2e-3
    env.close()


def test_a_controller_that_trusts_the_start_values_drops():
    """Why the prior is needed: mu_c 1.3 asks for a third of the force that holds."""
    env = HoldEnv(friction_source="estimated", material="wood")
    trusting = policies.make("hold", prior=ConservativePrior(mu_c=1.3, r=0.02), reserve=0.0, k_v=0.0)
    info, largest = play(env, trusting, 0, object_mass=0.4, shake_amplitude=0.0, duration=2.0)
    env.close()
    assert info["dropped"] or largest > 2e-3


@pytest.mark.parametrize("heuristic", [True, False])
def test_the_heuristic_keeps_mu_c_near_truth_in_stick_slip(heuristic):
    """Direction of the paper's table: without it mu_c reads clearly low, with it near truth."""
    env = LinearSlipEnv(estimator={"name": "rls", "heuristic": heuristic}, material="case")
    info, _ = play(env, policies.make("linear_slip"), 0, distance=0.04, duration=5.0)
    env.close()
    ratio = info["estimated"][1] / info["true"][1]
    # the paper's largest ratio without the heuristic is 0.72; with it, first samples at mu_s pull up
    assert ratio == pytest.approx(1.0, abs=0.12) if heuristic else ratio < 0.75


@pytest.mark.parametrize("sensors", ["realistic", "ideal"])
def test_joint_knows_the_latency_of_the_slip_sensor(sensors):
    """One sample off, mu_c collapses or reads a fifth too high."""
    env = LinearSlipEnv(estimator="joint", sensors=sensors, material="case")
    info, _ = play(env, policies.make("linear_slip"), 0, distance=0.02, duration=2.0)
    env.close()
    assert info["estimated"][1] == pytest.approx(info["true"][1], rel=0.05)


def observation(task="Hold", **values):
    index = ObservationIndex(task, load())
    row = np.zeros((1, 18 + len(find(task).columns) + 6))
    for name, value in values.items():
        row[0, index[name]] = value
    return Columns(row, index)


@pytest.mark.parametrize(("support", "expected"), [(0.0, 0.3), (0.25, 0.35), (0.5, 0.4), (1.0, 0.4)])
def test_the_prior_blends_with_confidence(support, expected):
    columns = observation(mu_c=0.4, confidence_mu_c=support)
    assert ConservativePrior(mu_c=0.3, confidence=0.5).blend(columns, "mu_c") == pytest.approx(expected)


@pytest.mark.parametrize(
    "bad", [{"mu_c": 0.0}, {"mu_c": np.nan}, {"r": -1.0}, {"confidence": 0.0}, {"confidence": 1.5}]
)
def test_the_prior_refuses_bad_values(bad):
    with pytest.raises(ValueError, match=next(iter(bad))):
        ConservativePrior(**bad)


def test_hold_force_is_load_and_reserve_over_friction():
    columns = observation(
        f_y_1=-1.0, f_y_2=-1.0, tau_1=0.01, tau_2=0.01, mu_c=0.5, r=0.01, confidence_mu_c=1, confidence_r=1
    )
    policy = policies.make("hold", reserve=0.5, margin=1.2)
    force, _ = policy.control(columns, policy.initial_state(1))
    # scaled load sqrt(1 + (0.01 / 0.01)^2) = sqrt(2)
    assert force == pytest.approx(1.2 * (np.sqrt(2.0) + 0.5) / 0.5)


@pytest.mark.parametrize(("name", "env_class"), CONTROLLERS)
def test_a_batch_is_its_rows(name, env_class):
    env = env_class()
    rows = [env.reset(seed=seed)[0] for seed in range(3)]
    env.close()
    policy = policies.make(name)
    batch, _ = policy.predict(np.stack(rows))
    single = [policy.predict(row)[0] for row in rows]
    np.testing.assert_array_equal(batch, np.stack(single))


@pytest.mark.parametrize(("name", "env_class"), CONTROLLERS)
def test_without_friction_part_the_controller_says_what_it_needs(name, env_class):
    env = env_class(friction_source="none")
    row, _ = env.reset(seed=0)
    env.close()
    with pytest.raises(ValueError, match="friction_source"):
        policies.make(name).predict(row)


@pytest.mark.parametrize(
    ("name", "bad"),
    [
        ("linear_slip", {"smoothing": 1.0}),
        ("rotational_slip", {"smoothing": -0.1}),
        ("hinge", {"smoothing": 1.0}),
        ("hinge", {"k_min": 4.0}),
        ("planar_slip", {"wrist_acceleration": 0.0}),
        ("hold", {"decay": -0.1}),
        ("hold", {"gain": 1}),
    ],
)
def test_bad_parameters_are_named(name, bad):
    with pytest.raises(ValueError, match=next(iter(bad))):
        policies.make(name, **bad)


@pytest.mark.parametrize("source", ["estimated", "true"])
@pytest.mark.parametrize(("angle", "duration"), [(0.2618, 5.0), (1.0472, 2.0)])
def test_rotational_slip_arrives(source, angle, duration):
    env = RotationalSlipEnv(friction_source=source, estimator="joint")
    info, largest = play(env, policies.make("rotational_slip"), 2, angle=angle, duration=duration)
    env.close()
    assert info["is_success"]
    # what the limit surface asks for at d = 180 mm, and the leaps' share
    assert largest < 1.2 * 2.0 * 0.01**2 / 0.18 * np.log(np.tan(np.pi / 4 + angle / 4))


@pytest.mark.parametrize("source", ["estimated", "true"])
@pytest.mark.parametrize(("turn", "direction", "duration"), [(0.2618, -1, 5.0), (1.0472, 1, 2.0)])
def test_hinge_hangs(source, turn, direction, duration):
    env = HingeEnv(friction_source=source, estimator="joint")
    policy = policies.make("hinge")
    info, _ = play(env, policy, 1, turn=turn, direction=direction, duration=duration)
    env.close()
    assert info["is_success"]
    assert abs(info["reference"][0]) == pytest.approx(turn, rel=1e-3)


def test_hinge_without_its_loose_start_swings_up():
    """Why k_stick is below mu_s / mu_c: static friction takes the object along."""
    env = HingeEnv(friction_source="true", material="plastic")
    info, _ = play(env, policies.make("hinge", k_stick=2.0), 0, duration=2.0)
    env.close()
    assert not info["is_success"]


@pytest.mark.slow
@pytest.mark.parametrize(("source", "least"), [("estimated", 0.70), ("true", 0.80)])
def test_hinge_hangs_with_the_sensors_of_a_laboratory(source, least):
    """Some two standard deviations of 200 episodes below the 77 and 87 % of docs/results/worth.txt."""
    policy = policies.make("hinge")
    arguments = {**policies.modes(policy), "friction_source": source, "level": "hard", "sensors": "lab"}
    assert play_episodes("Hinge", policy, arguments, range(200)).strength[0] >= least


@pytest.mark.parametrize(
    ("support", "tilt", "k"), [(0.0, 0.01, 0.95), (0.0, 0.05, 0.95), (0.0, 0.1, 0.475), (1.0, 0.1, 1.2)]
)
def test_hinge_lets_go_with_the_tilt_while_friction_is_unknown(support, tilt, k):
    load, mu_c = 1.0, 0.5
    seen = {"wrist_pitch": -tilt, "wrist_pitch_goal": -1.0, "mu_c": mu_c, "confidence_mu_c": support}
    columns = observation("Hinge", f_y_1=load, f_y_2=load, **seen)
    policy = policies.make("hinge")
    force, _ = policy.control(columns, policy.initial_state(1))
    assert force == pytest.approx(k * load / (mu_c if support else policy.prior.mu_c))


def test_hinge_knows_friction_before_the_turn():
    """While the wrist rests it explores, unless friction is known or it is not to."""
    for source, gains in (("estimated", {}), ("estimated", {"known": 0.0}), ("true", {})):
        env = HingeEnv(friction_source=source, engine="planar")
        observation, info = env.reset(seed=0, options={"mu_c": 0.7, "mu_s": 0.9})
        policy, state = policies.make("hinge", **gains), None
        for _ in range(59):
            action, state = policy.predict(observation, state)
            observation, _, _, _, info = env.step(action)
        env.close()
        slid = np.hypot(*info["slip"][:2])
        if source == "estimated" and not gains:
            assert info["estimated"][1] == pytest.approx(0.7, rel=0.15)
            assert 1e-5 < slid < 5e-4
        else:
            assert slid < 1e-5


@pytest.mark.parametrize("source", ["estimated", "true"])
@pytest.mark.parametrize(("heading", "turn"), [(0.8, 0.5), (-0.3, -0.25)])
@pytest.mark.quick_cases("0.8-0.5-estimated")
def test_planar_slip_arrives(source, heading, turn):
    env = PlanarSlipEnv(friction_source=source, material="case")
    info, _ = play(env, policies.make("planar_slip"), 4, slide=0.014, heading=heading, turn=turn)
    env.close()
    assert info["is_success"]


def test_planar_slip_follows_the_grasped_point():
    """Travel is the sum of velocities at the pad centre; what it has slid turns with the object."""
    index = ObservationIndex("PlanarSlip", load(), "grip_force_pitch")
    policy = policies.make("planar_slip")
    state = policy.initial_state(1)
    for travel in [(0.0, -0.01, 0.0), *((0.0, -0.01, angle) for angle in np.linspace(0.0, 0.5, 200))]:
        row = np.zeros((1, index["confidence_r"] + 1))
        for name, value in zip(
            ("measured_slip_x", "measured_slip_y", "measured_slip_theta"), travel, strict=True
        ):
            row[0, index[name]] = value
        row[0, [index["mu_c"], index["r"], index["confidence_mu_c"], index["confidence_r"]]] = (
            0.4,
            0.005,
            1.0,
            1.0,
        )
        _, state = policy.control(Columns(row, index), state)
    np.testing.assert_allclose(state[0, :2], [0.01 * np.sin(0.5), -0.01 * np.cos(0.5)], rtol=2e-3)
