"""A learned policy's episode can be recorded, every sample of it."""

import gymnasium as gym
import numpy as np
import pytest

import policies
from estimator import records
from policies.evaluation.sensor_record import TWIST, check_targets, record_sensors, save_record
from slipgym.envs.arguments import DEFAULT_ESTIMATOR


def test_every_sample_within_its_steps_is_kept(policy_folder, tmp_path):
    arguments = {"friction_source": "estimated", "frame_skip": 4}
    folder = policy_folder(environment={"arguments": arguments, "rate": 30.0})
    options = {"duration": 0.5, "material": "wood"}
    frame = record_sensors("Hold", str(folder), finger=2, seed=3, options=options)

    policy, over, steps = policies.load(folder), False, 0
    env = gym.make("slipgym:slipgym/Hold-v0", **policy.modes)
    observation, _ = env.reset(seed=3, options=options)
    while not over:
        observation, _, terminated, truncated, info = env.step(policy.predict(observation)[0])
        steps, over = steps + 1, terminated or truncated
    samples = round(info["time"] * 120)
    env.close()
    assert 4 * (steps - 1) < samples <= 4 * steps
    assert frame[list(TWIST)].notna().all(axis=1).sum() == samples

    for name in ("log.parquet", "log.h5"):
        save_record(frame, tmp_path / name)
        ours = records.estimate(records.load(tmp_path / name), DEFAULT_ESTIMATOR).estimates[-1]
        np.testing.assert_allclose(
            [ours[name] for name in ("mu_s", "mu_c", "r")], info["estimated_per_finger"][1], rtol=1e-9
        )


@pytest.mark.parametrize("name", ["log.xlsx", "log.npz", "log.bag", "log"])
def test_a_type_that_cannot_be_written_is_refused_before_the_episode(tmp_path, name):
    with pytest.raises(ValueError, match=rf"{name}: unknown file type; records are \.csv, .*\.h5"):
        check_targets(tmp_path / name)


@pytest.mark.slow  # it compiles for a sensor with more samples
def test_more_samples_than_a_sensor_keeps_are_refused():
    config = {"sensors": {"force_torque": {"rate": 7560}}}  # 63 in a control step
    with pytest.raises(ValueError, match=r"rate = 7560 Hz: 65 samples.* at most 64"):
        record_sensors("Hold", "hold", options={"duration": 0.1}, config=config)
    config = {"sensors": {"force_torque": {"rate": 7200}}}
    frame = record_sensors("Hold", "hold", options={"duration": 0.1, "material": "wood"}, config=config)
    assert frame["f_n"].notna().sum() == 720


def test_an_engine_that_leaves_samples_out_is_refused():
    with pytest.raises(ValueError, match="engine = 'planar' takes only the samples that are read"):
        record_sensors("Hold", "hold", engine="planar")


def test_a_policy_of_another_environment_is_refused(policy_folder):
    with pytest.raises(ValueError, match="the policy was trained for another observation"):
        record_sensors("LinearSlip", str(policy_folder()))
    with pytest.raises(FileNotFoundError, match="no policy at 'nowhere'"):
        record_sensors("Hold", "nowhere")


@pytest.mark.slow  # it compiles for a sensor with more samples
def test_the_sensor_of_the_other_finger_may_be_later():
    """The same episode, whichever finger is recorded: both are read on the way."""
    late = {"sensors": {"force_torque": {"latency_spread": 0.03, "own_latency": True}}}
    known = {"sensors": "ideal", "config": late, "friction_source": "estimated", "seed": 1}
    found = [record_sensors("LinearSlip", "linear_slip", finger=f, **known) for f in (1, 2)]
    first, second = (frame["t"][frame["f_x"].notna()].iloc[0] for frame in found)
    assert second > first + 0.01
    slips = [frame.loc[frame["v_x"].notna(), list(TWIST)].to_numpy() for frame in found]
    np.testing.assert_allclose(*slips, atol=1e-12)  # the mirror rounds
