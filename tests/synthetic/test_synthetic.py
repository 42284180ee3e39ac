"""Synthetic records against what was prescribed."""

import numpy as np
import pytest

from slipgym.contact import DistributedContact, EllipsoidContact
from slipgym.synthetic import Course, ideal, integrate, sense

SLIDE = Course.start(mu_c=0.4, mu_s=0.5, r=0.008, normal=5.0).to("stick", 0.1).to("slide", 0.05, v_x=0.02)
COURSE = SLIDE.to("slide", 0.4, omega=1.0).to("change", 0.4, mu_c=0.5, mu_s=0.7, r=0.010, normal=4.0)


@pytest.fixture(scope="module")
def trace():
    return integrate(COURSE)


def test_a_course_is_linear_between_its_points():
    t = np.array([0.0, 0.1, 0.125, 0.35, 0.75])
    v_x, _, omega, normal, mu_c, _, r = COURSE.at(t)
    np.testing.assert_allclose(v_x, [0.0, 0.0, 0.01, 0.02, 0.02], atol=1e-15)
    np.testing.assert_allclose(omega, [0.0, 0.0, 0.0, 0.5, 1.0], atol=1e-12)
    np.testing.assert_allclose([normal[-1], mu_c[-1], r[-1]], [4.5, 0.45, 0.009], rtol=1e-12)
    assert COURSE.phases(t[1:]).tolist() == ["stick", "slide", "slide", "change"]
    assert COURSE.phases(np.array([0.55]))[0] == "slide"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"v_z": 1.0}, "v_z"),
        ({"mu_c": 0.8}, "mu_s"),
        ({"normal": 0.0}, "normal"),
        ({"omega": np.nan}, "finite"),
    ],
)
def test_a_course_refuses(changes, words):
    with pytest.raises(ValueError, match=words):
        SLIDE.to("bad", 0.1, **changes)
    with pytest.raises(ValueError, match=words):
        Course.start(**changes)


def test_a_piece_has_a_duration():
    with pytest.raises(ValueError, match="duration"):
        SLIDE.to("bad", 0.0)


def test_motion_is_the_integral_of_the_twist(trace):
    travelled = trace.motion.sum(axis=0)
    # x: ramp of 0.05 s, then constant; theta: ramp of 0.4 s, then constant
    np.testing.assert_allclose(travelled, [0.02 * (0.025 + 0.8), 0.0, 0.2 + 0.4], rtol=1e-3, atol=1e-15)
    assert len(trace.t) == 114
    assert trace.t[-1] == pytest.approx(0.95)


def test_steady_translation_has_its_closed_form():
    trace = integrate(SLIDE.to("slide", 0.2), DistributedContact(sigma_2=0.2))
    # mu_c + sigma_2 v; what the cells of a translation share is exact to rounding
    assert trace.wrench[-1, 0] == pytest.approx(-(0.4 + 0.2 * 0.02) * 5.0, rel=1e-9)
    assert trace.wrench[-1, 2] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("make", [DistributedContact, EllipsoidContact])
def test_friction_and_radius_follow_the_course(make):
    spin = (
        Course.start(r=0.008).to("spin", 0.05, omega=2.0).to("spin", 0.3, mu_c=0.3, r=0.012).to("spin", 0.1)
    )
    trace = integrate(spin, make(sigma_2=0.0))
    # 21 x 21 cells about the centre: those slower than 2 v_s are few, their excess is below 0.2 %
    assert trace.wrench[-1, 2] == pytest.approx(-0.3 * 5.0 * 0.012, rel=2e-3)
    assert trace.r[-1] == 0.012


@pytest.mark.parametrize("make", [DistributedContact, EllipsoidContact])
def test_a_change_keeps_the_bristles_and_refuses_nonsense(make):
    contact = make()
    contact.step((0.01, 0.0, 0.0), 5.0, 1e-4)
    before = contact.bristles
    contact.change(mu_c=0.3, mu_s=0.45, effective_radius=0.012)
    np.testing.assert_array_equal(contact.bristles, before)
    assert contact.effective_radius == pytest.approx(0.012, rel=1e-12)
    for wrong in ({"mu_c": 0.0}, {"mu_s": 0.1}, {"effective_radius": 0.0}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            contact.change(**{"mu_c": 0.3, "mu_s": 0.45, "effective_radius": 0.012, **wrong})


def test_one_cell_has_no_radius_to_change():
    with pytest.raises(ValueError, match="one cell"):
        DistributedContact(cells=1).change(mu_c=0.4, mu_s=0.5, effective_radius=0.01)


def test_a_radius_that_changes_keeps_the_pressure():
    contact = DistributedContact(radius=0.010, pressure="hertz")
    contact.change(mu_c=0.4, mu_s=0.5, effective_radius=1.5 * contact.effective_radius)
    larger = DistributedContact(radius=0.015, pressure="hertz")
    np.testing.assert_allclose(contact.positions, larger.positions, rtol=1e-12, atol=1e-15)


def test_ideal_sensors_report_the_trace(trace):
    exact, sensed = ideal(trace), sense(trace, m=2, sensors="ideal")
    np.testing.assert_allclose(sensed.twists, np.broadcast_to(exact.twists, sensed.twists.shape), atol=1e-12)
    np.testing.assert_allclose(sensed.wrenches, np.broadcast_to(exact.wrenches, (2, 114, 4)), atol=1e-15)
    np.testing.assert_array_equal(exact.wrenches[0, :, 0], -trace.wrench[:, 0])
    np.testing.assert_array_equal(ideal(trace, instant=True).twists[0], trace.twist)


@pytest.mark.parametrize("latency", [0, 1, 3])
def test_realistic_sensors_are_late_noisy_and_count(trace, latency):
    record = sense(trace, m=20, seed=1, config={"sensors": {"slip": {"latency_samples": latency}}})
    assert record.wrenches.shape == (20, 114, 4)
    late = np.concatenate([np.zeros((latency, 3)), trace.motion[: len(trace.t) - latency]]) * 120
    # an axis is off by less than a count, 0.95 mm/s; the twist is a mean over axes, omega's lever 24.3 mm
    assert np.abs(record.twists[..., :2] - late[:, :2]).max() < 2 * 7.94e-6 * 120
    assert np.abs(record.twists[..., 2] - late[:, 2]).max() < 2 * 7.94e-6 * 120 / 0.0243
    error = record.wrenches[..., 2] - trace.normal
    # 2280 draws: the sample's sd is within 5 of its own standard deviations, 1.5 % each
    assert error.std() == pytest.approx(0.04, rel=0.075)
    assert len(np.unique(error[:, 0])) == 20


def test_records_are_told_by_their_seed(trace):
    first, again, other = (sense(trace, m=3, seed=seed) for seed in (0, 0, 1))
    np.testing.assert_array_equal(first.wrenches, again.wrenches)
    np.testing.assert_array_equal(first.twists, again.twists)
    assert not np.array_equal(first.twists, other.twists)


def test_there_is_at_least_one_record(trace):
    with pytest.raises(ValueError, match="m = 0"):
        sense(trace, m=0)
