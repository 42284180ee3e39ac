"""Logs of the bench whose streams have other rates, tables or rows."""

import numpy as np
import pytest
from typer.testing import CliRunner

from estimator.records import load_columns
from lab.simulated_gripper import draw_gripper, simulated_log, write_log
from policies.commands.map import app
from slipgym.identification import read_log


@pytest.fixture(scope="module")
def log():
    return simulated_log(draw_gripper(0), names=("press", "slide x"))


SLIP = ["v_x", "v_y", "omega"]


def rows_between(log, own, folder):
    """A csv of a log whose velocities `own` have rows and times of their own."""
    pandas = pytest.importorskip("pandas")
    write_log(log, folder / "log.csv")
    forces = pandas.read_csv(folder / "log.csv").drop(columns=SLIP)
    pandas.concat([forces, own]).sort_values("t").to_csv(folder / "log.csv", index=False)
    return folder / "log.csv"


@pytest.mark.parametrize("way", ["empty cells", "rows between", "velocity_t", "packed"])
def test_velocities_of_a_third_of_the_rate(log, tmp_path, way):
    """They are at the rows next to their times, with their value there: a phase is no latency."""
    pandas = pytest.importorskip("pandas")
    write_log(log, tmp_path / "log.csv")
    frame = pandas.read_csv(tmp_path / "log.csv")
    at, mapping, path = np.arange(1, len(frame), 3), tmp_path / "mapping.yaml", tmp_path / "log.csv"
    phase = 0.0 if way == "empty cells" else 0.3 / log.rate
    own = frame.loc[at, ["t", *SLIP]].assign(t=frame.t[at] + phase)
    if way == "empty cells":
        frame.loc[~frame.index.isin(at), SLIP] = np.nan
    elif way == "packed":  # in the first rows, with a time that needs no mapping
        packed = own.rename(columns={"t": "velocity_t"}).reset_index(drop=True)
        frame = frame.drop(columns=SLIP).join(packed)
    if way == "rows between":
        rows_between(log, own, tmp_path)
    elif way == "velocity_t":
        path = tmp_path / "log.npz"
        forces = {name: values.to_numpy() for name, values in frame.drop(columns=SLIP).items()}
        np.savez(path, stamp=own.t, **forces, **{name: own[name].to_numpy() for name in SLIP})
        mapping.write_text("velocity_t: stamp")
    else:
        frame.to_csv(path, index=False)
    read = read_log(path, load_columns(mapping if mapping.exists() else None))
    there = np.isfinite(read.readings[:, 4:]).all(axis=1)
    assert np.flatnonzero(there).tolist() == at.tolist()
    np.testing.assert_allclose(read.readings[:, :4], log.readings[:, :4], atol=1e-8)
    wanted = [np.interp(frame.t[at], own.t, own[name]) for name in SLIP]
    np.testing.assert_allclose(read.readings[there, 4:], np.transpose(wanted), atol=1e-8)


def test_faster_velocities_keep_their_time(log, tmp_path):
    pandas = pytest.importorskip("pandas")
    t = np.arange(0.0, (len(log.command) - 1) / log.rate, 1e-3)
    own = pandas.DataFrame({"t": t, **{name: t * (k + 1) * 1e-3 for k, name in enumerate(SLIP)}})
    read = read_log(rows_between(log, own, tmp_path))
    rows = np.arange(len(log.command)) / log.rate
    inside = rows <= t[-1]
    wanted = rows[inside, None] * np.array([1e-3, 2e-3, 3e-3])
    np.testing.assert_allclose(read.readings[inside, 4:], wanted, atol=1e-6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda own: own.assign(t=own.t + 1e4), "on one clock"),
        (lambda own: own.assign(t=own.t + 0.7 * own.t.max()), "on one clock"),
        (lambda own: own.assign(t=1e3 * own.t), "velocity samples are .* s apart"),
        (lambda own: own.assign(omega=np.nan), "omega must be a finite number"),
    ],
)
def test_velocities_of_another_clock_are_refused(log, tmp_path, change, message):
    pandas = pytest.importorskip("pandas")
    write_log(log, tmp_path / "whole.csv")
    own = pandas.read_csv(tmp_path / "whole.csv")[["t", *SLIP]].iloc[::3]
    with pytest.raises(ValueError, match=message):
        read_log(rows_between(log, change(own), tmp_path))


def test_a_command_of_an_unknown_unit_is_refused(log, tmp_path):
    write_log(log, tmp_path / "log.csv")
    (tmp_path / "mapping.yaml").write_text("force: 'force [%]'")
    text = (tmp_path / "log.csv").read_text()
    (tmp_path / "log.csv").write_text(text.replace("force", "force [%]", 1))
    with pytest.raises(ValueError, match=r"force \[%\]: unknown unit '%'; .*`force: \{scale: …\}`"):
        read_log(tmp_path / "log.csv", load_columns(tmp_path / "mapping.yaml"))


def test_a_proposal_without_a_slip_sensor_goes_on_with_identify(log, tmp_path):
    pandas = pytest.importorskip("pandas")
    write_log(log, tmp_path / "whole.csv")
    frame = pandas.read_csv(tmp_path / "whole.csv").drop(columns=SLIP)
    frame.to_csv(tmp_path / "log.csv", index=False)
    said = CliRunner().invoke(app, [str(tmp_path / "log.csv"), "--output", str(tmp_path / "m.yaml")]).output
    assert "slipgym estimate does not take it" in said
    assert f"slipgym identify {tmp_path / 'log.csv'} --columns {tmp_path / 'm.yaml'}" in said
    frame.drop(columns="force").to_csv(tmp_path / "log.csv", index=False)
    (tmp_path / "m.yaml").unlink()
    said = CliRunner().invoke(app, [str(tmp_path / "log.csv"), "--output", str(tmp_path / "m.yaml")]).output
    assert "slipgym estimate does not take it" in said
    assert "slipgym identify" not in said


def test_a_refusal_names_the_row_of_the_file(log, tmp_path):
    pandas = pytest.importorskip("pandas")
    write_log(log, tmp_path / "whole.csv")
    own = pandas.read_csv(tmp_path / "whole.csv")[["t", *SLIP]].iloc[::3]
    path = rows_between(log, own.assign(t=own.t + 0.3 / log.rate), tmp_path)
    frame = pandas.read_csv(path)
    row = frame.index[frame.f_x.notna()][-200]
    for column, value, message in (("force", -1.0, "force must be >= 0"), ("t", None, "equal steps")):
        changed = frame.copy()
        if column == "t":
            changed.loc[row:, "t"] += 3.0 / log.rate
        else:
            changed.loc[row, column] = value
        changed.to_csv(path, index=False)
        with pytest.raises(ValueError, match=f"row {row + 1}: .*{message}"):
            read_log(path)


def test_motion_and_command_of_another_table_may_begin_later_and_end_earlier(log, tmp_path):
    h5py, pandas = pytest.importorskip("h5py"), pytest.importorskip("pandas")
    write_log(log, tmp_path / "log.csv")
    frame = pandas.read_csv(tmp_path / "log.csv")
    robot = frame[["t", "force", "motion_x", "motion_y", "motion_omega"]].iloc[50:-40:2]
    with h5py.File(tmp_path / "log.h5", "w") as file:
        for group, part in (("ft", frame[["t", "f_x", "f_y", "f_n", "tau", *SLIP]]), ("robot", robot)):
            for name, values in part.items():
                file[f"{group}/{name}"] = values.to_numpy()
    read = read_log(tmp_path / "log.h5")
    assert len(log.command) - 95 < len(read.command) < len(log.command) - 80
    np.testing.assert_allclose(read.readings[0], log.readings[50], atol=1e-8)


UNITS_WRONG = [
    ("f_n", -1.0, r"f_n is negative throughout \(median .* N\).*`f_n: \{sign: -1\}`"),
    ("f_n", 1e3, r"row \d+: f_n must be .* of at most 10000 N in each row, is \S+ N; in mN\? `f_n"),
    ("tau", 1e3, r"tau reaches .* N m .*; in N mm\?"),
    ("force", 4e2, r"force goes along with f_n, but changes by .* N .*`force: \{unit: mN\}`"),
    ("force", 12.75, r"force goes along with f_n, but changes by .* N .*convert force to N"),
    ("motion_x", 1e3, r"row \d+: motion_x must be .* of at most 5 m/s in each row, is .* m/s; in mm/s\?"),
    ("motion_x", 1e2, r"motion_x goes along with v_x, but changes by .* m/s .*`motion_x: \{unit: cm/s\}`"),
    ("motion_omega", 57.3, r"motion_omega goes along with omega.*`motion_omega: \{unit: deg/s\}`"),
    ("v_x", 1e2, r"motion_x goes along with v_x, but changes by .* m/s .*`v_x: \{unit: cm/s\}`"),
    ("omega", 57.3, r"motion_omega goes along with omega.*`omega: \{unit: deg/s\}`"),
]


@pytest.fixture(scope="module")
def turned():
    return simulated_log(draw_gripper(0), names=("press", "slide and squeeze"))


@pytest.mark.parametrize(("key", "factor", "message"), UNITS_WRONG)
def test_a_wrong_unit_or_sign_is_refused_with_value_and_unit(turned, tmp_path, key, factor, message):
    pandas = pytest.importorskip("pandas")
    write_log(turned, tmp_path / "log.csv")
    frame = pandas.read_csv(tmp_path / "log.csv")
    frame[key] *= factor
    frame.to_csv(tmp_path / "log.csv", index=False)
    with pytest.raises(ValueError, match=rf"log\.csv: {message}"):
        read_log(tmp_path / "log.csv")


def test_a_motion_without_a_slip_sensor_has_a_bound_of_its_own(turned, tmp_path):
    pandas = pytest.importorskip("pandas")
    write_log(turned, tmp_path / "log.csv")
    frame = pandas.read_csv(tmp_path / "log.csv").drop(columns=SLIP)
    frame["motion_y"] *= 1e3
    frame.to_csv(tmp_path / "log.csv", index=False)
    with pytest.raises(ValueError, match=r"motion_y must be .* of at most 5 m/s"):
        read_log(tmp_path / "log.csv")


@pytest.mark.parametrize("cut", [100, 550, 599, 600, 601, 1100])
def test_a_missing_row_is_refused_wherever_it_is(log, tmp_path, cut):
    pandas = pytest.importorskip("pandas")
    write_log(log, tmp_path / "log.csv")
    frame = pandas.read_csv(tmp_path / "log.csv")
    assert len(frame) == 1200
    frame.drop(index=[cut]).to_csv(tmp_path / "log.csv", index=False)
    with pytest.raises(
        ValueError, match=rf"row {cut + 1}: t = .* s is 16.67 ms after .* 8.333 ms.*equal steps"
    ):
        read_log(tmp_path / "log.csv")


@pytest.mark.parametrize("way", ["jitter", "rounded"])
def test_stamps_that_are_not_exact_are_no_missing_rows(log, tmp_path, way):
    pandas = pytest.importorskip("pandas")
    write_log(log, tmp_path / "log.csv")
    frame = pandas.read_csv(tmp_path / "log.csv")
    frame["t"] = frame.t.round(3) if way == "rounded" else frame.t
    if way == "jitter":
        frame["t"] += np.random.default_rng(0).normal(0.0, 1e-3, len(frame))
    frame.to_csv(tmp_path / "log.csv", index=False)
    assert read_log(tmp_path / "log.csv").rate == pytest.approx(log.rate, rel=1e-3)
