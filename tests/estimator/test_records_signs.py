"""One flipped axis, and a torque or velocity in another unit, are named with the line that mends them."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from estimator import records
from estimator.records.alignment import align
from estimator.records.summary import faults

SHIPPED = Path(__file__).parents[2] / "examples" / "linear_slip_wood.csv.gz"
FORCE, TWIST = ("f_x", "f_y", "f_n", "tau"), ("v_x", "v_y", "omega")


def told(frame):
    record = records.from_arrays(frame)
    return [line for line in faults(record, align(record, allow_gaps=True)) if "held" not in line]


def columns(t, wrench, twist):
    return {"t": t, **dict(zip(FORCE, wrench.T, strict=True)), **dict(zip(TWIST, twist.T, strict=True))}


@pytest.fixture(scope="module")
def turning(planar_slip):
    """A slip whose direction turns round, with spin."""
    record = planar_slip(turn=2.0, fingers=1)
    return columns(record.t, record.wrenches[0], record.twists[0])


@pytest.fixture(scope="module")
def spinning(planar_slip):
    record = planar_slip(gamma_t=0.1, fingers=1)
    return columns(record.t, record.wrenches[0], record.twists[0])


def changed(frame, **factors):
    return {name: factors.get(name, 1.0) * values for name, values in frame.items()}


@pytest.mark.parametrize(("axis", "other"), [("v_x", "f_x"), ("f_x", "v_x"), ("v_y", "f_y"), ("f_y", "v_y")])
def test_one_flipped_axis_is_named(turning, axis, other):
    (line,) = told(changed(turning, **{axis: -1.0}))
    assert f"{min(axis, other)} goes against {max(axis, other)} in slip" in line
    for name in (axis, other):
        assert f"`{name}: {{sign: -1}}`" in line


@pytest.mark.parametrize("name", ["omega", "tau"])
def test_a_flipped_rotation_is_named(spinning, name):
    (line,) = told(changed(spinning, **{name: -1.0}))
    assert "tau goes against omega in slip" in line
    assert "`omega: {sign: -1}` or `tau: {sign: -1}` in the mapping turns it" in line


@pytest.mark.parametrize("names", [FORCE, TWIST])
def test_all_signs_together_are_told_in_one_line(turning, names):
    (line,) = told(changed(turning, **dict.fromkeys(set(names) - {"f_n"}, -1.0)))
    assert "those of the pad on the object? `f_x: {sign: -1}`, `f_y: {sign: -1}`" in line


@pytest.mark.parametrize(
    ("factors", "words"),
    [
        ({"tau": 15.0}, r"is it in N cm? `tau: {unit: N cm}`"),
        ({"v_x": 100.0, "v_y": 100.0}, r"`v_x: {unit: cm/s}` and `v_y: {unit: cm/s}`"),
        ({"v_x": 60.0, "v_y": 60.0}, r"`v_x: {unit: cm/s}` and `v_y: {unit: cm/s}`"),
    ],
)
def test_a_torque_or_a_velocity_in_another_unit_is_named(turning, factors, words):
    (line,) = told(changed(turning, **factors))
    assert words in line


def test_a_torque_in_n_cm_that_no_pad_holds_is_refused_by_its_unit(turning):
    with pytest.raises(ValueError, match=r"in N cm\? `tau: \{unit: N cm\}`"):
        told(changed(turning, tau=100.0))


@pytest.mark.parametrize(("speed", "unit"), [(7.0, "cm/s"), (12.0, "cm/s"), (30.0, "mm/s")])
def test_a_velocity_that_no_slip_has_is_refused_by_its_unit(turning, speed, unit):
    fast = changed(turning, v_y=speed / np.abs(turning["v_y"]).max())
    with pytest.raises(ValueError, match=rf"v_y = .* in {unit}\? `v_y: \{{unit: {unit}\}}`"):
        told(fast)


SCENARIOS = {
    "turning": lambda make: make["planar_slip"](turn=2.0),
    "straight": lambda make: make["planar_slip"](turn=0.0, gamma_t=1.0),
    "spinning": lambda make: make["planar_slip"](gamma_t=0.05),
    "jump": lambda make: make["planar_slip"](jump=0.5),
    "scatter": lambda make: make["planar_slip"](scatter=0.3),
    "light": lambda make: make["planar_slip"](f_n=1.5),
    "stick-slip": lambda make: make["stick_slip"](),
    "short slips": lambda make: make["short_slips"](),
}


@pytest.mark.parametrize("scenario", SCENARIOS)
@pytest.mark.parametrize("late", [0, 3])
def test_records_without_fault_give_no_alarm(scenario, late, planar_slip, stick_slip, short_slips):
    make = {"planar_slip": planar_slip, "stick_slip": stick_slip, "short_slips": short_slips}
    record = SCENARIOS[scenario](make)
    for wrench, twist in zip(record.wrenches, np.roll(record.twists, late, axis=1), strict=True):
        assert told(columns(record.t, wrench, twist)) == []


def test_nor_does_the_example_nor_a_sensor_with_zero_errors(turning):
    frame = pd.read_csv(SHIPPED)
    assert told(frame) == []
    for sign in (-1.0, 1.0):
        off = {"f_x": 0.3, "f_y": -0.3, "tau": 1.5e-3}
        assert told({k: v + sign * off.get(k, 0.0) for k, v in turning.items()}) == []


@pytest.mark.parametrize("rate", [120.0, 1000.0])
def test_an_object_that_falls_is_not_in_another_unit(rate):
    t = np.arange(0.0, 1.3, 1.0 / rate)
    speed, zero = 6.0 * np.maximum(t - 1.0, 0.0), np.zeros_like(t)
    force = np.where(speed > 0.0, 1.5, 1.9 * np.minimum(t, 1.0))
    wrench, twist = np.column_stack([force, zero, zero + 5.0, zero]), np.column_stack([speed, zero, zero])
    assert not [line for line in told(columns(t, wrench, twist)) if "cm/s" in line]


def test_a_pad_that_springs_back_has_no_wrong_sign():
    t = np.arange(0.0, 3.3, 1e-3)
    force, zero = 4.0 * np.clip(np.minimum(t / 3.0, (3.2 - t) / 0.08), 0.0, 1.0), np.zeros_like(t)
    speed = 1e-4 * np.gradient(force, t)
    wrench, twist = np.column_stack([force, zero, zero + 12.0, zero]), np.column_stack([speed, zero, zero])
    assert not [line for line in told(columns(t, wrench, twist)) if "against" in line]
