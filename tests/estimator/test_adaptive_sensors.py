"""The estimator "adaptive" is told nothing of its sensors' delays, zero errors, tilt and CoP."""

import numpy as np
import pytest

import estimator
from estimator.window.layout import TILT, ZERO
from policies.leaderboard.imperfections import Imperfections, impaired
from tests.estimator.exact_records import RATE

NOISE = 0.02, 0.02, 0.04, 5e-4
"""Of f_x, f_y, f_n, tau [N, N, N, N m]."""


def replayed(name, record, **parameters):
    """Estimates (fingers, samples) of a record, and the estimators."""
    batch = estimator.make_batch(name, len(record.wrenches), **parameters)
    wrenches, twists = (np.ascontiguousarray(a.swapaxes(0, 1)) for a in (record.wrenches, record.twists))
    kept = np.empty((len(record.t), len(batch)), batch.estimates.dtype)
    for k, t in enumerate(record.t.tolist()):
        batch.update(t, wrenches[k], twists[k])
        kept[k] = batch.estimates
    return kept.T, batch


def errors(estimates, record, field, at):
    return estimates[field][:, at] / getattr(record, field)[at] - 1.0


@pytest.mark.parametrize("jitter", [0.0, 0.3])
@pytest.mark.parametrize("delay", [0, 1, 2, 4])
def test_stick_slip_with_a_delay_that_nobody_tells(stick_slip, delay, jitter):
    late = impaired(stick_slip(), Imperfections(velocity_delay=delay, jitter=jitter), seed=delay)
    estimates, batch = replayed("adaptive", late)
    slip = (late.phase == "slip") & (late.t > 1.5)
    assert slip.sum() > 40
    assert np.abs(errors(estimates, late, "mu_c", slip).mean(axis=1)).max() < 0.05
    assert np.abs(errors(estimates, late, "mu_s", slip).mean(axis=1)).max() < 0.06
    assert set(batch.states["delay"]) <= {delay, delay + (jitter > 0.0)}


def test_the_others_fail_there(stick_slip):
    """What the estimator is for: two samples late, "disc" with its nominal delay of one loses mu_c."""
    late = impaired(stick_slip(), Imperfections(velocity_delay=2))
    slip = (late.phase == "slip") & (late.t > 1.5)
    assert np.median(errors(replayed("disc", late)[0], late, "mu_c", slip)) < -0.5


@pytest.mark.parametrize("force_delay", [0.004, 0.01])
def test_a_late_force_sensor(stick_slip, force_delay):
    late = impaired(stick_slip(), Imperfections(velocity_delay=1, force_delay=force_delay))
    slip = (late.phase == "slip") & (late.t > 1.5)
    found, _ = replayed("adaptive", late)
    assert abs(errors(found, late, "mu_c", slip).mean()) < 0.05
    assert np.abs(errors(found, late, "mu_c", slip).mean(axis=1)).max() < 0.06  # fingers differ by 0.5 %


ONE_BY_ONE = {
    "none": Imperfections(velocity_delay=1),
    "zero": Imperfections(velocity_delay=1, zero=0.2),
    "tilt": Imperfections(velocity_delay=1, tilt=np.deg2rad(2.0)),
    "cop": Imperfections(velocity_delay=1, cop=0.002),
}
ALL = Imperfections(velocity_delay=1, zero=0.2, tilt=np.deg2rad(2.0), cop=0.002)


@pytest.mark.parametrize("turn", [1.0, 2.0])
@pytest.mark.parametrize("which", ONE_BY_ONE)
def test_planar_slip_with_one_error(planar_slip, which, turn):
    """Within 6 % after 3 s, if the direction of the slip has turned by 170 degrees or more."""
    record = impaired(planar_slip(turn), ONE_BY_ONE[which], seed=2)
    estimates, _ = replayed("adaptive", record)
    for field in ("mu_c", "r"):
        assert np.abs(errors(estimates, record, field, record.t > 3.25)).max() < 0.06, field


@pytest.mark.parametrize("hertz", [False, True])
def test_planar_slip_with_all_errors(planar_slip, hertz):
    record = impaired(planar_slip(1.0, hertz=hertz), ALL, seed=3)
    estimates, _ = replayed("adaptive", record)
    for field in ("mu_c", "r"):
        assert np.abs(errors(estimates, record, field, record.t > 3.25)).max() < 0.10, field


def test_an_unloaded_sensor_shows_its_zero_error(stick_slip):
    """Half a second before the grasp; without it no motion of a hanging block tells the error from mu_c."""
    record = stick_slip()
    wrenches = np.random.default_rng(0).normal(size=(8, 60, 4)) * (0.02, 0.02, 0.02, 5e-4)
    wrenches[..., 1] += 0.2
    est = estimator.make_batch("adaptive", 8)
    for k in range(60):
        est.update((k - 60) / 120, np.ascontiguousarray(wrenches[:, k]), np.zeros((8, 3)))
    np.testing.assert_allclose(est.states["x"][:, ZERO + 1], 0.2, atol=0.02)
    biased = record.wrenches + np.array([0.0, 0.2, 0.0, 0.0])
    for k, t in enumerate(record.t.tolist()):
        est.update(t, np.ascontiguousarray(biased[:, k]), np.ascontiguousarray(record.twists[:, k]))
    np.testing.assert_allclose(est.estimates["mu_c"], 0.4, rtol=0.05)


@pytest.mark.parametrize("jump", [1.35, 0.7])
def test_a_jump_of_friction(planar_slip, jump):
    """Within 5 % again after 0.3 s, and for the rest of the record."""
    record = impaired(planar_slip(0.0, jump=jump), Imperfections(velocity_delay=1))
    estimates, _ = replayed("adaptive", record)
    assert np.abs(errors(estimates, record, "mu_c", record.t > 2.3)).max() < 0.05


def test_the_same_bits_for_every_sign_convention(planar_slip):
    """The wrench on the object instead of that on the finger."""
    record = planar_slip(fingers=2)
    for_finger, _ = replayed("adaptive", record)
    record.wrenches[..., [0, 1, 3]] *= -1.0
    for_object, _ = replayed("adaptive", record)
    np.testing.assert_allclose(for_object["mu_c"], for_finger["mu_c"], rtol=1e-9)
    np.testing.assert_allclose(for_object["r"], for_finger["r"], rtol=1e-9)


def test_changes_of_the_grip_at_rest_show_the_tilt():
    """An open gripper, a straight slip, a load of 1 N at rest while the grip is 5 or 10 N, a slip."""
    est, rng = estimator.make("adaptive"), np.random.default_rng(0)
    for i in range(400):
        slips, open_ = 40 <= i < 100 or i >= 340, i < 40
        f_n = 0.0 if open_ else 2.5 if slips else 5.0 + 5.0 * (i // 30 % 2)
        f_t = 0.0 if open_ else 0.4 * f_n if slips else 1.0
        wrench = np.array([0.02 * f_n, f_t + 0.04 * f_n, f_n, 0.0]) + rng.normal(size=4) * NOISE
        found = est.update((i + 1) / RATE, wrench, (0.0, 0.02 if slips else 0.0, 0.0))
    assert found.mu_c == pytest.approx(0.4, rel=0.03)


def test_a_grip_in_proportion_to_the_load_is_no_tilt():
    est, rng, k = estimator.make("adaptive"), np.random.default_rng(0), 0
    for i in range(720):
        f_t = 1.0 + 0.5 * np.sin(0.05 * i)
        wrench = np.array([0.0, f_t, 5.0 * f_t, 0.0]) + rng.normal(size=4) * NOISE
        est.update((k := k + 1) / RATE, wrench, (0.0, 0.0, 0.0))
    np.testing.assert_allclose(est.batch.states["x"][0, TILT : TILT + 2], 0.0, atol=0.01)
