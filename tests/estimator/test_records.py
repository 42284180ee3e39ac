"""Records through the estimator, against independent computations and known truth."""

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import estimator
from estimator import records
from estimator.records.plot import plot

ROOT = Path(__file__).parents[2]
SHIPPED = ROOT / "examples" / "linear_slip_wood.csv.gz"
FORCE, TWIST = ["f_x", "f_y", "f_n", "tau"], ["v_x", "v_y", "omega"]


def split(table):
    """The table as two: forces and velocities."""
    return table.dropna(subset="f_n")[["t", *FORCE]], table.dropna(subset="omega")[["t", *TWIST]]


def test_each_velocity_sample_gets_the_newest_force_at_or_before_it(table, save):
    forces, twists = split(table)
    samples = records.estimate(records.load(save(table))).samples
    wanted = []
    for t in twists["t"]:
        row = None
        for at, *wrench in forces.to_numpy():
            if at > t:
                break
            row = wrench
        wanted.append(row)
    np.testing.assert_array_equal(samples.t, twists["t"])
    np.testing.assert_array_equal(samples.wrench, wanted)
    np.testing.assert_array_equal(samples.twist, twists[TWIST])


def test_the_estimates_are_those_of_the_online_estimator(table, save):
    result = records.estimate(records.load(save(table)), "rls", forgetting=0.95)
    one = estimator.make("rls", forgetting=0.95)
    samples = result.samples
    for k, t in enumerate(samples.t):
        assert one.update(t, samples.wrench[k], samples.twist[k]) == result.estimates[k].item()
    assert result.estimates[-1]["mu_c"] == pytest.approx(0.4, rel=0.02)
    assert result.estimates[-1]["r"] == pytest.approx(0.012, rel=0.02)


@pytest.mark.parametrize("kind", ["csv", "csv.gz", "parquet"])
def test_one_file_and_two_files_say_the_same(table, save, kind):
    one = records.load(save(table, f"log.{kind}"))
    forces, twists = split(table)
    velocity = save(twists.rename(columns={"t": "stamp"}), f"velocity.{kind}")
    columns = records.Columns({"velocity_t": records.Column("stamp", "s", 1.0)})
    two = records.load(save(forces, f"force.{kind}"), columns, velocity)
    for name in ("force_t", "wrench", "twist_t", "twist"):
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))


@pytest.mark.parametrize("told_by", ["cop", "tilt"])
def test_wrench_and_twist_move_to_the_cop(table, save, told_by):
    at_pad = records.estimate(records.load(save(table)))
    x, y = 0.004, -0.003  # where the force acts, from the sensor's origin
    moved = table.assign(
        tau=table["tau"] + x * table["f_y"] - y * table["f_x"],
        v_x=table["v_x"] + table["omega"] * y,
        v_y=table["v_y"] - table["omega"] * x,
    )
    if told_by == "cop":
        moved = moved.assign(cop_x=x, cop_y=y)
    else:
        moved = moved.assign(tau_x=y * table["f_n"], tau_y=-x * table["f_n"])
    again = records.estimate(records.load(save(moved)))
    np.testing.assert_allclose(again.samples.wrench, at_pad.samples.wrench, atol=1e-12)
    np.testing.assert_allclose(again.samples.twist, at_pad.samples.twist, atol=1e-12)


def test_the_example_mapping_turns_names_units_and_signs(tmp_path):
    plain = records.estimate(records.load(SHIPPED))
    frame = pd.read_csv(SHIPPED)
    theirs = pd.DataFrame({"stamp": 1e3 * frame["t"], "Fx": frame["f_x"], "Fy": frame["f_y"]})
    theirs["Fz"] = -frame["f_n"]
    for name, key in (("Mx", "tau_x"), ("My", "tau_y"), ("Mz", "tau"), ("slip_x", "v_x"), ("slip_y", "v_y")):
        theirs[name] = 1e3 * frame[key]
    theirs["slip_rate"] = np.degrees(frame["omega"])
    theirs.to_parquet(tmp_path / "theirs.parquet")
    columns = records.load_columns(ROOT / "examples" / "columns.yaml")
    result = records.estimate(records.load(tmp_path / "theirs.parquet", columns))
    assert result.samples.truth is None
    for name in ("mu_s", "mu_c", "r"):
        np.testing.assert_allclose(result.estimates[name], plain.estimates[name], rtol=1e-9)


def test_the_shipped_record_gives_its_friction():
    """A slide of up to 90 mm/s with viscous friction: mu_c within 3 %, mu_s within 5 %, r not observed.

    sigma_2 v adds 0.2 s/m × up to 0.09 m/s to the ratio of forces, about 4 % of mu_c, of which one slide
    separates a part.
    """
    assert SHIPPED.stat().st_size < 300_000
    result = records.estimate(records.load(SHIPPED))
    last, (mu_s, mu_c, r) = result.estimates[-1], result.samples.truth[-1]
    assert (mu_s, mu_c, r) == (0.5155, 0.3623, 0.01)
    assert last["mu_c"] == pytest.approx(mu_c, rel=0.03)
    assert last["mu_s"] == pytest.approx(mu_s, rel=0.05)
    assert (last["r"], last["updates_r"]) == (0.01, 0)
    assert "r: not observed: this is the start value" in records.report(result)


def test_rls_reads_viscous_friction_as_mu_c():
    """3 to 7 % high; without viscous friction 1 % high, which is left of the start value 1.3."""
    last = records.estimate(records.load(SHIPPED), "rls").estimates[-1]
    assert 1.03 < last["mu_c"] / 0.3623 < 1.07


def test_without_the_heuristic_the_shipped_record_collapses():
    plain = records.estimate(records.load(SHIPPED), "rls", heuristic=False)
    assert plain.estimates[-1]["mu_c"] < 0.8 * 0.3623
    assert not plain.estimates["halted"].any()


def test_a_gap_starts_the_estimator_afresh(table, save):
    cut = table.loc[(table["t"] < 0.8) | (table["t"] > 1.2)]
    record = records.load(save(cut))
    with pytest.raises(ValueError, match=r"no velocity for more than 41\.7 ms: 0\.791667 to 1\.208333 s"):
        records.estimate(record)
    result = records.estimate(record, allow_gaps=True)
    after = result.samples.segment == 1
    assert result.samples.t[after][0] == pytest.approx(1.208333)
    assert set(result.samples.segment) == {0, 1}
    alone = records.estimate(records.load(save(table.loc[table["t"] > 1.2], "second.csv")))
    np.testing.assert_array_equal(result.estimates[after], alone.estimates)
    assert "starts afresh" in records.report(result)


def test_velocities_in_a_gap_of_the_forces_are_left_out(table, save):
    lost = table["t"].between(0.8, 1.2)
    record = records.load(
        save(table.assign(**{name: table[name].mask(lost) for name in FORCE}).dropna(how="all"))
    )
    with pytest.raises(ValueError, match=r"no force for more than .* 0\.799 to 1\.201 s"):
        records.estimate(record)
    samples = records.estimate(record, allow_gaps=True).samples
    assert samples.left_out == len(record.twist_t) - len(samples.t) > 45
    assert math.isclose(np.diff(samples.segment).sum(), 1)


def test_a_run_writes_what_it_found(table, save, tmp_path):
    result = records.estimate(records.load(save(table.assign(true_mu_c=0.4))), "rls", heuristic=False)
    folder = tmp_path / "run"
    folder.mkdir()
    records.write(result, folder)
    assert {path.name for path in folder.iterdir()} == {
        "estimates.csv",
        "estimates.parquet",
        "estimates.png",
        "summary.md",
    }
    exact, short = pd.read_parquet(folder / "estimates.parquet"), pd.read_csv(folder / "estimates.csv")
    np.testing.assert_array_equal(exact["mu_c"], result.estimates["mu_c"])
    assert list(short) == list(exact)
    page = (folder / "summary.md").read_text()
    for words in (
        "heuristic = False",
        "| mu_c | 0.4",
        "at 1000 Hz",
        "at 120 Hz",
        "2.0",
        "mu_s: not observed",
    ):
        assert words in page


def test_seconds_since_1970_are_a_clock_too(table, save):
    plain = records.estimate(records.load(save(table)))
    later = records.estimate(records.load(save(table.assign(t=1.7e9 + table["t"]), "log.parquet")))
    np.testing.assert_allclose(later.estimates["mu_c"], plain.estimates["mu_c"])
    axes = plot(later).axes[-1]
    assert axes.get_xlabel() == "time since the start [s]"
    assert axes.get_xlim() == pytest.approx((0.0, 2.0), abs=2e-3)


def test_no_contact_is_said(table, save):
    table["f_n"] *= 0.01
    result = records.estimate(records.load(save(table.assign(tau=0.0 * table["tau"]))))
    assert "there was no contact" in records.report(result)
    assert records.report(result).count("not observed") == 0
