"""Sensors as a user's gripper has them: what an episode samples, and that nobody is told."""

import gymnasium as gym
import numpy as np
import pytest

import estimator as estimators
from slipgym.config import load
from slipgym.contact.records import pads
from slipgym.contact.soft_pad import load_pad
from slipgym.envs.reset_kernels import CLOSING_STEPS
from slipgym.sensors.force_torque import read_force_torque, sample_force_torque
from slipgym.sensors.misalignment import mount
from slipgym.sensors.slip_velocity import accumulate_slip, read_slip, sample_slip
from slipgym.sensors.starting import draw_sensors, start_sensors
from slipgym.sensors.unloaded import READINGS, read_unloaded
from slipgym.world.plant import build

FORCE, COP = np.array([-1.5, 0.7, 4.0]), np.array([0.001, -0.002])
QUIET = {"noise_tangential": 0.0, "noise_normal": 0.0, "noise_torque": 0.0}


def started(seed: int = 0, **sensors):
    """Sensors of both fingers at the start of an episode: FORCE_TORQUE (2,) and SLIP_SENSOR (2,)."""
    plant = build(load({"sensors": sensors}, "ideal"))
    start_sensors(plant.force_torque[0], plant.slip_sensors[0], *draw_sensors(2, np.random.default_rng(seed)))
    return plant.force_torque[0], plant.slip_sensors[0]


def reading(sensor, force=FORCE, torque=0.012, cop=COP) -> np.ndarray:
    """What a sensor reads of a force on the finger, torque about the normal and centre of pressure."""
    pad = pads(1)[0]
    pad["wrench"], pad["cop"] = (-force[0], -force[1], -torque), cop
    load_pad(pad, force[2])
    values = np.zeros(6)
    sample_force_torque(sensor, pad, sensor["period"] * 100)
    read_force_torque(sensor, sensor["period"] * 100 + sensor["delay"], values)
    return values


@pytest.mark.parametrize("finger", [0, 1])
def test_off_centre_shifts_the_centre_of_pressure(finger):
    """Moments about another point: the force is the same, and the centre of pressure off by as much."""
    aligned, off = (started(force_torque={"off_centre": e})[0][finger] for e in (0.0, 0.002))
    before, after = reading(aligned), reading(off)
    np.testing.assert_allclose(after[:3], before[:3], rtol=1e-14)
    shift = np.array([-after[4] + before[4], after[3] - before[3]]) / FORCE[2]
    assert 0.0 < np.abs(shift).max() <= 0.002
    twist = shift[0] * FORCE[1] - shift[1] * FORCE[0]
    assert after[5] - before[5] == pytest.approx(aligned["mirror"] * twist, rel=1e-12)


def test_tilt_turns_forces_and_moments():
    tilted = [started(seed, force_torque={"tilt": 0.05})[0][0] for seed in range(200)]
    turns = []
    for sensor in tilted:
        value = reading(sensor)
        assert np.linalg.norm(value[:3]) == pytest.approx(np.linalg.norm(FORCE), rel=1e-12)
        mix = sensor["mix"]
        np.testing.assert_allclose(mix[:3, :3] @ mix[:3, :3].T, np.eye(3), atol=1e-14)
        np.testing.assert_array_equal(mix[3:, 3:], mix[:3, :3])
        assert not mix[:3, 3:].any()
        assert not mix[3:, :3].any()
        turns.append([mix[2, 1], mix[2, 0]])
    assert np.abs(turns).max() <= np.sin(0.05)
    # uniform: mean 0, standard deviation most / 3^0.5; bounds of four standard errors
    assert np.abs(np.mean(turns, axis=0)).max() < 4 * 0.05 / 3**0.5 / 200**0.5
    assert np.std(turns) == pytest.approx(0.05 / 3**0.5, rel=0.15)


def test_cross_talk_is_a_part_of_the_range():
    sensor = started(force_torque={"crosstalk": 0.02})[0][0]
    scaled = sensor["mix"] / sensor["range"][:, None] * sensor["range"]
    np.testing.assert_array_equal(np.diag(scaled), 1.0)
    off = scaled[~np.eye(6, dtype=bool)]
    assert np.abs(off).max() <= 0.02
    assert np.std(off) == pytest.approx(0.02 / 3**0.5, rel=0.4)


def test_mounting_is_sampled_anew_from_the_key():
    sensor = started(force_torque={"tilt": 0.05, "crosstalk": 0.02, "off_centre": 0.002})[0][0]
    first = sensor["mix"].copy()
    mount(sensor)
    np.testing.assert_array_equal(sensor["mix"], first)
    sensor["drift_key"] += 1
    mount(sensor)
    assert (sensor["mix"] != first).mean() > 0.9


def test_latencies_are_sampled_and_shared_by_the_fingers():
    slips, forces = [], []
    for seed in range(300):
        force_torque, slip = started(
            seed,
            force_torque={"latency": 0.001, "latency_spread": 0.01},
            slip={"latency_samples": 1, "latency_spread": 4},
        )
        assert force_torque["delay"][0] == force_torque["delay"][1]
        assert slip["delay"][0] == slip["delay"][1]
        forces.append(force_torque["delay"][0])
        slips.append(slip["delay"][0])
    assert set(slips) == {1, 2, 3, 4, 5}
    assert (min(forces), max(forces)) == (12, 132)
    counts = np.bincount(slips)[1:]
    assert np.abs(counts - 60).max() < 4 * (300 * 0.2 * 0.8) ** 0.5


SLIPS, FORCES = {"latency_samples": 1, "latency_spread": 4}, {"latency": 1 / 12e3, "latency_spread": 4 / 12e3}


@pytest.mark.parametrize(("which", "group", "late"), [(0, "force_torque", FORCES), (1, "slip", SLIPS)])
def test_each_finger_may_have_its_own_latency(which, group, late):
    pairs, shared = [], []
    for seed in range(400):
        pairs.append(started(seed, **{group: late | {"own_latency": True}})[which]["delay"].copy())
        shared.append(started(seed, **{group: late})[which]["delay"].copy())
    own = np.array(pairs)
    np.testing.assert_array_equal(own[:, 0], np.array(shared)[:, 0])
    together = np.bincount(5 * (own[:, 0] - 1) + own[:, 1] - 1, minlength=25)
    assert ((together - 16) ** 2 / 16).sum() < 51.2, "independent: chi-square of 24 degrees, 0.1 %"


def test_scale_and_a_failed_chip():
    failed, scales = 0, []
    for seed in range(200):
        sensor = started(seed, slip={"scale_error": 0.05, "chip_failure": 0.1})[1][0]
        failed += sensor["failed"] >= 0
        scales.append(sensor["scale"])
        twist, motion = np.zeros(3), np.array([1e-3, 0.0, 0.0])
        accumulate_slip(sensor, motion)
        sample_slip(sensor)
        read_slip(sensor, twist)
        assert twist[0] == pytest.approx(sensor["scale"] * motion[0] * 120, rel=1e-9)
    assert 0.95 < min(scales) < 0.96
    assert 1.04 < max(scales) < 1.05
    assert abs(failed - 20) < 4 * (200 * 0.09) ** 0.5


def test_late_readings_lose_no_motion():
    """A reading may be a sample older or the last one again; measured slip has all samples delivered."""
    sensor = started(slip={"jitter": 0.3, "dropout": 0.05})[1][0]
    rng, twist, true, late, again, last = np.random.default_rng(0), np.zeros(3), [np.zeros(3)], 0, 0, None
    for k in range(2000):
        motion = rng.normal(size=3) * (1e-4, 1e-4, 1e-2)
        true.append(true[-1] + motion)
        accumulate_slip(sensor, motion)
        sample_slip(sensor)
        read_slip(sensor, twist)
        again += last is not None and (twist == last).all()
        behind = [
            np.allclose(sensor["measured_slip"], true[k + 1 - n], rtol=1e-9, atol=1e-12)
            for n in range(min(6, k + 2))
        ]
        assert any(behind)
        late += not behind[0]
        last = twist.copy()
    # late if the reading is old (0.3) or lost (0.05); one older after a reading of the newest repeats it
    assert abs(late / 2000 - 0.335) < 0.05
    assert again > 0.05 * 2000


def test_a_lost_force_reading_is_the_last_one_again():
    sensor = started(force_torque={"dropout": 0.2})[0][0]
    pad, values, last, again = pads(1)[0], np.zeros(6), np.zeros(6), 0
    for k in range(1, 1001):
        load_pad(pad, 1.0 + 0.01 * k)
        sample_force_torque(sensor, pad, sensor["period"] * k)
        read_force_torque(sensor, sensor["period"] * k, values)
        again += (values == last).all()
        last = values.copy()
    assert abs(again - 200) < 4 * (1000 * 0.16) ** 0.5


@pytest.mark.parametrize("estimator", ["adaptive", "joint", "disc", "ukf"])
def test_nobody_is_told(estimator):
    """Estimators have the same parameters, whatever an episode has sampled, and know only what they read."""
    with gym.make("slipgym/LinearSlip-v0", engine="planar", sensors="lab", estimator=estimator) as made:
        env = made.unwrapped
        told, sampled = set(), set()
        for seed in range(5):
            env.reset(seed=seed)
            learner, sensors = env.simulation.estimator, env.simulation.plant
            told.add(learner.parameters_array.tobytes())
            sampled.add((sensors.slip_sensors["delay"][0, 0].item(), sensors.force_torque["mix"].tobytes()))
            alone = estimators.make_batch(**env.simulation.estimator_choice, n=2)
            alone.parameters_array = learner.parameters_array
            alone.reset()
            readings = np.zeros((2, READINGS, 4))
            for sensor, rows in zip(sensors.force_torque[0], readings, strict=True):
                read_unloaded(sensor, rows)
            for k in range(READINGS):
                at = (k + 1 - READINGS - CLOSING_STEPS) * env.simulation.step_time
                alone.update(at, np.ascontiguousarray(readings[:, k]), np.zeros((2, 3)))
            np.testing.assert_array_equal(alone.states, learner.states)
            np.testing.assert_array_equal(alone.estimates, learner.estimates)
        assert len(told) == 1
        assert len(sampled) == 5


def test_resting_chips_count_late_and_lose_nothing():
    """Against counting by hand: at a look a chip counts all that has moved."""
    looks = set()
    rng, rest = (
        np.random.default_rng(2),
        {"rest_after": 0.1, "rest_period": 0.05, "counts": True, "count": 1e-5},
    )
    motions = np.where(np.arange(200) // 25 % 2, rng.uniform(0.0, 1e-3, 200), 0.0)
    for seed in range(60):
        sensor = started(seed, slip=rest)[1][0]
        period, phase, carry = sensor["rest_samples"], sensor["rest_phase"], sensor["carry"][0:6:2].copy()
        counts, still = np.zeros(3), 0
        looks.add(int(period))
        for k in range(len(motions)):
            accumulate_slip(sensor, np.array([motions[k], 0.0, 0.0]))
            sample_slip(sensor)
            if period <= 1 or still < 12 or k % period == phase:
                new = np.maximum(np.trunc((carry + motions[: k + 1].sum()) / 1e-5), 0.0)
                still = 0 if (new != counts).any() else still + 1
                counts = new
            np.testing.assert_allclose(sensor["travel"][:3], counts * 1e-5, rtol=1e-9)
    assert looks == set(range(7))
