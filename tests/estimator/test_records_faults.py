"""What a record tells of faults: a force zeroed in the grip, dead channels, two clocks, a viscosity."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from estimator import records
from estimator.reasons import Doubts
from estimator.records.alignment import align
from estimator.records.calibration import Calibration, Found
from estimator.records.faults import fault_warnings
from estimator.records.summary import warnings

SHIPPED = Path(__file__).parents[2] / "examples" / "linear_slip_wood.csv.gz"


def told(frame, columns=None):
    record = records.from_arrays(frame, None, columns)
    return "\n".join(fault_warnings(record, align(record, allow_gaps=True)))


def shipped():
    return pd.read_csv(SHIPPED)


def lifted(table):
    """A grip of 8 N that is loosened to 3 N while the object slips."""
    f_n = np.interp(table["t"], [0.0, 2.0], [8.0, 3.0])
    there = table["f_n"].notna()
    share = 0.4 * f_n / np.sqrt(2.0)
    return table.assign(f_n=np.where(there, f_n, np.nan), f_y=np.where(there, share, np.nan))


def test_a_normal_force_zeroed_in_the_grip_is_not_turned(table, mapping):
    zeroed = lifted(table).assign(f_n=lambda frame: frame["f_n"] - 8.0)
    with pytest.raises(
        ValueError, match=r"negative throughout .* zeroed in the grip.* `f_n: \{offset: 5\}`"
    ) as told_:
        records.from_arrays(zeroed)
    assert "sign: -1" not in str(told_.value)
    right = records.from_arrays(zeroed, None, mapping("f_n: {offset: 8}"))
    np.testing.assert_allclose(right.wrench[:, 2], records.from_arrays(lifted(table)).wrench[:, 2], atol=1e-9)


def test_a_normal_force_of_the_other_sign_is_turned(table):
    with pytest.raises(ValueError, match=r"negative throughout .* `f_n: \{sign: -1\}`"):
        records.from_arrays(lifted(table).assign(f_n=lambda frame: -frame["f_n"]))


def test_a_normal_force_below_zero_is_told(table):
    assert told(table) == ""
    f_n = table["f_n"].where(table["t"] > 0.3, -4.0).where(table["f_n"].notna())
    said = told(table.assign(f_n=f_n))
    assert "f_n goes down to -4 N" in said
    assert "offset: …" in said  # the least of the missing force is no remedy: friction would be too large


def test_more_friction_than_there_can_be_is_told(table):
    assert "tangential force is" in told(lifted(table).assign(f_n=lambda f: (f["f_n"] - 5.5).clip(-0.2)))


@pytest.mark.parametrize("zero", [-1.8, -2.0, -2.3])
def test_a_slip_with_too_little_normal_force_is_named(zero):
    """Zeroed in a grip of 2 N f_n is below zero in a quarter of the slip, but not by a tenth of its peak."""
    frame = shipped().assign(f_n=lambda table: table["f_n"] + zero)
    line = told(frame)
    assert "% of the slip f_n is less than a third of the tangential force, down to -" in line
    assert "zeroed in the grip" in line
    record = records.from_arrays(frame)
    report = records.report(records.estimate(record))
    assert "mu_c: not observed: this is the start value, although 102 samples slip: f_n is below" in report
    assert "slip with translation" not in report


def test_noise_and_zero_errors_in_a_light_grip_are_no_fault(table):
    """A grip of 0.4 N on rubber of friction 1, with a zero error of -0.1 N and noise of 0.05 N."""
    light = table.assign(f_n=0.08 * table["f_n"], tau=0.0 * table["tau"])
    noise = 0.05 * np.random.default_rng(1).standard_normal(len(light))
    light = light.assign(f_y=light["f_n"], f_n=light["f_n"] - 0.1 + noise)
    assert "zeroed in the grip" not in told(light)


def test_the_grippers_own_force(table, mapping):
    own = table.assign(motor=1.1e3 * table["f_n"])
    columns = mapping("grip: {column: motor, unit: mN}")
    record = records.from_arrays(own, None, columns)
    np.testing.assert_allclose(record.grip, 1.1 * record.wrench[:, 2])
    assert records.from_arrays(own).grip is None
    assert told(own, columns) == ""
    assert "own force is 11 N" in told(table.assign(motor=2.2e3 * table["f_n"]), columns)
    slow = own.assign(motor=own["motor"].where(np.arange(len(own)) % 50 == 0))
    assert told(slow, columns) == ""


def test_the_grippers_own_force_may_be_of_another_rate(table, mapping, tmp_path):
    forces, twists = table.dropna(subset="f_n"), table.dropna(subset="omega")
    arrays = {f"ft/{name}": forces[name].to_numpy() for name in ("t", "f_x", "f_y", "tau")}
    arrays |= {f"slip/{name}": twists[name].to_numpy() for name in ("t", "v_x", "v_y", "omega")}
    motor = forces.iloc[20::33]
    arrays |= {"motor/t": motor["t"].to_numpy(), "motor/load": motor["f_n"].to_numpy()}
    np.savez(tmp_path / "log.npz", **arrays)
    record = records.load(tmp_path / "log.npz", mapping("f_n: motor/load"))
    first = motor["t"].iloc[0]
    assert record.force_t[0] == first
    assert len(record.force_t) == (forces["t"] >= first).sum()
    at = np.searchsorted(motor["t"], record.force_t, side="right") - 1
    np.testing.assert_array_equal(record.wrench[:, 2], motor["f_n"].to_numpy()[at])
    stopped = arrays | {name: arrays[name][:20] for name in ("motor/t", "motor/load")}
    np.savez(tmp_path / "log.npz", **stopped)
    ends = records.load(tmp_path / "log.npz", mapping("f_n: motor/load")).force_t[-1] - motor["t"].iloc[19]
    assert 0.16 < ends <= 0.166


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"f_x": 0.3}, "f_x never changes"),
        ({"f_x": 0.3, "f_y": 1.0, "f_n": 5.0, "tau": 0.01}, "no force ever changes"),
        ({"v_x": 0.001, "v_y": 0.0, "omega": 0.0}, "no velocity ever changes"),
    ],
)
def test_a_channel_that_is_frozen_from_the_beginning_is_told(table, change, message):
    table = shipped() if "v_x" in change else table
    frozen = table.assign(**{name: table[name] * 0.0 + value for name, value in change.items()})
    assert message in told(frozen)


@pytest.mark.parametrize("way", [("cop_x", "cop_y"), ("tau_x", "tau_y")])
def test_a_frozen_force_is_named_beside_a_cop_that_moves(table, way):
    """The CoP changes the torque alone."""
    there = 0.0 * table["f_n"]
    moving = table.assign(**{name: there + 1e-3 * np.sin(table["t"]) for name in way})
    assert told(moving) == ""
    assert "f_n never changes" in told(moving.assign(f_n=5.0 + there))
    still = {"f_x": 0.3, "f_y": 1.0, "f_n": 5.0, "tau": 0.01}
    line = told(moving.assign(**{name: value + there for name, value in still.items()}))
    assert "no force ever changes" in line


@pytest.mark.parametrize("offset", [0.05, -0.06, 0.2, -0.4])
def test_two_clocks_are_told(offset, mapping):
    """The shipped record's velocities are one to two samples late by their sensor."""
    frame = shipped()
    assert told(frame) == ""
    columns = mapping(f"velocity_t: {{column: t, offset: {offset}}}")
    line = told(frame, columns)
    assert "two clocks" in line
    said = float(line.split("offset: ")[1].split("}")[0])
    assert -said == pytest.approx(offset + 0.0125, abs=0.009)
    again = mapping(f"velocity_t: {{column: t, offset: {offset + said}}}")
    assert "two clocks" not in told(frame, again)


def test_noise_alone_has_no_two_clocks():
    rng = np.random.default_rng(3)
    for n in (500, 2000):
        t = np.arange(n) / 100
        forces = {name: 1.0 + 0.1 * rng.standard_normal(n) for name in ("f_x", "f_y", "f_n")}
        twists = {name: 0.01 * rng.standard_normal(n) for name in ("v_x", "v_y", "omega")}
        assert "two clocks" not in told({"t": t, **forces, "tau": 1e-3 * rng.standard_normal(n), **twists})


def test_a_negative_viscosity_is_told(table):
    result = records.estimate(records.from_arrays(table))
    viscosity = Found("sigma_2", "s/m", -0.2, 0.04, 0.12)
    found = Calibration(0, 0.0, False, (viscosity,), Doubts())
    assert any("sigma_2 = -0.2 s/m" in line for line in warnings(replace(result, calibration=found)))
    for harmless in (
        replace(viscosity, value=0.2),
        replace(viscosity, sd=0.119),
        replace(viscosity, value=-0.05),
    ):
        calm = replace(found, errors=(harmless,))
        assert not any("sigma_2" in line for line in warnings(replace(result, calibration=calm)))
