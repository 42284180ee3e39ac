"""Leaps of PlanarSlip's controller, step by step and with a slip velocity of unknown delay."""

import numpy as np
import pytest

import policies
from policies.controllers import leaps
from policies.controllers.leaps import LeapGains, Slip

GAINS = LeapGains()
FORCE_MAX = 25.0
JUMP = {
    "disturbances": [
        {
            "kind": "friction_jump",
            "probability": 1.0,
            "time": {"uniform": [1.0, 10.0]},
            "factor": {"uniform": [0.7, 1.35]},
        }
    ]
}


def asked(load=2.0, distance=0.01, begins=False, turning=False, speed=0.0, wanted=True):
    values = {"load": load, "distance": distance, "speed": speed, "f_slip": 2.5, "held": 20.0}
    flags = {"wanted": wanted, "begins": begins, "turning": turning}
    return Slip(**{name: np.array([value]) for name, value in (values | flags).items()})


def falling(n=8, **changes):
    """Memory after n control steps in which the grip falls, and the commands."""
    state, commands = leaps.begin(1, GAINS), []
    for k in range(n):
        force, state = leaps.leap(state, asked(begins=k == 0, **changes), GAINS, FORCE_MAX)
        commands.append(force[0])
    return state, np.array(commands)


def test_the_grip_falls_until_the_object_breaks_away():
    _, commands = falling()
    np.testing.assert_allclose(commands[1:] / commands[:-1], GAINS.keep)
    assert commands[0] == pytest.approx(GAINS.keep * GAINS.start * 2.5 * 2.0)


def test_a_fall_of_the_force_begins_a_leap_that_ends_after_its_time_without_any_velocity():
    state, _ = falling()
    commands = []
    for _ in range(6):
        force, state = leaps.leap(state, asked(load=1.5), GAINS, FORCE_MAX)
        commands.append(force[0])
    length = min(GAINS.share * 0.01, GAINS.slide)
    steps = int(np.sqrt(length / GAINS.reach) - leaps.BEGUN)
    assert np.flatnonzero(np.array(commands) == FORCE_MAX).tolist() == [steps]
    assert state.clock[0] < 0.0


@pytest.mark.parametrize(("fall", "begins"), [(0.5 * GAINS.fall, False), (1.2 * GAINS.fall, True)])
def test_a_small_fall_is_none(fall, begins):
    state, _ = falling()
    _, state = leaps.leap(state, asked(load=2.0 * (1.0 - fall)), GAINS, FORCE_MAX)
    assert (state.clock[0] != 0.0) == begins


def test_noise_of_the_load_widens_what_counts_as_a_fall():
    rng = np.random.default_rng(0)
    state = leaps.begin(1, GAINS)
    for _ in range(300):  # at rest
        load = 2.0 + 0.1 * rng.standard_normal()
        _, state = leaps.leap(state, asked(load=load, wanted=False), GAINS, FORCE_MAX)
    assert state.noise[0] == pytest.approx(0.1, rel=0.3)


def after_leap(length, turning=False):
    """Memory after a leap of a length was measured."""
    state, _ = falling(turning=turning, distance=0.5)
    for _ in range(30):
        load, left = (1.5, 0.5) if state.clock[0] >= 0.0 else (2.0, 0.5 - length)
        _, state = leaps.leap(state, asked(load=load, distance=left, turning=turning), GAINS, FORCE_MAX)
        if state.clock[0] == 0.0:
            break
    return state


def test_slides_get_less_time_if_they_were_long():
    assert after_leap(0.01).reach[0] > GAINS.reach > after_leap(0.0).reach[0] >= 0.7 * GAINS.reach


def test_turns_get_more_grip_if_they_were_long_and_less_if_short():
    assert after_leap(0.1, True).brake[0] > GAINS.start > after_leap(0.0, True).brake[0]


def test_at_half_the_rate_it_takes_half_the_steps():
    half = leaps.at_rate(GAINS, 60.0)
    assert half.keep == pytest.approx(GAINS.keep**2)
    assert half.turn_steps == GAINS.turn_steps // 2
    assert half.reach == pytest.approx(4.0 * GAINS.reach)
    assert leaps.at_rate(GAINS, leaps.RATE) == GAINS


@pytest.mark.slow
def test_planar_slip_is_continuous_where_time_is_short(play_batch):
    env_id, hard = "slipgym/PlanarSlip-v0", {"level": "hard", "friction_source": "true"}
    in_leaps = policies.make("planar_slip", prompt=0.0)
    assert play_batch(env_id, policies.make("planar_slip"), 100, 50_000, **hard).success >= 0.9
    assert play_batch(env_id, in_leaps, 100, 50_000, **hard).success <= 0.6


@pytest.mark.slow
@pytest.mark.parametrize("latency", [0, 2, 4])
def test_planar_slip_is_solved_however_late_the_velocity_is(latency, play_batch):
    """The controller is not given the latency. Regulated slips fail at 4 samples."""
    late = {"randomization": {"slip_latency": {"choices": [latency]}}, "friction_source": "estimated"}
    env_id = "slipgym/PlanarSlip-v0"
    assert play_batch(env_id, policies.make("planar_slip"), 200, 40_000, **late).success >= 0.9
    if latency == 4:
        assert play_batch(env_id, policies.make("planar_slip_continuous"), 100, 40_000, **late).success < 0.3


@pytest.mark.slow
def test_planar_slip_goes_on_after_a_jump_of_friction(play_batch):
    made = policies.make("planar_slip")
    found = {
        source: play_batch(
            "slipgym/PlanarSlip-v0", made, 200, 40_000, randomization=JUMP, friction_source=source
        )
        for source in ("estimated", "true")
    }
    assert found["estimated"].success >= max(0.92, found["true"].success - 0.05)
