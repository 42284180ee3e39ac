"""Logs of hidden grippers give their parameters back, and say what they do not show."""

import re
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

import slipgym  # noqa: F401
from lab.simulated_gripper import draw_gripper, simulated_log, write_log
from policies.commands.front import application
from slipgym import identification
from slipgym.config import load
from slipgym.identification import Log, identify, read_log
from slipgym.identification.parameters import NAMES, PARAMETERS, START, values_of

GRIPPER = draw_gripper(0)


@pytest.fixture(scope="module")
def log():
    return simulated_log(GRIPPER, names=("press", "slide x"))


@pytest.fixture(scope="module")
def result(log):
    return identify(log)


@pytest.fixture(scope="module")
def folder(result, tmp_path_factory):
    folder = tmp_path_factory.mktemp("identified")
    identification.write(result, folder)
    return folder


def found(result):
    return dict(zip(NAMES, values_of(result.point).tolist(), strict=True))


def test_known_parameters_are_recovered(result):
    for name, tolerance in (("mu_c", 0.03), ("force gain", 0.01), ("lag", 0.1), ("shear compliance", 0.1)):
        assert result.shown[NAMES.index(name)], name
        assert found(result)[name] == pytest.approx(GRIPPER.values[name], rel=tolerance), name
    assert found(result)["zero f_n"] == pytest.approx(GRIPPER.values["zero f_n"], abs=0.02)
    np.testing.assert_allclose(result.noise, GRIPPER.noise, rtol=0.3)
    assert "The model fits this log" in identification.verdict(result)


@pytest.mark.slow
@pytest.mark.parametrize("pressure", ["uniform", "hertz"])
def test_cells_of_the_fit_add_little_to_the_residual(pressure):
    hidden = draw_gripper(1)
    result = identify(simulated_log(hidden, 1, pressure=pressure, names=("slide x", "turn")))
    # 25 cells, in place of the 109 of the log, leave 1.9 to 3.1 times the noise
    assert (result.held_out[:2] < 1.6 * hidden.noise[:2]).all()


def test_what_is_not_shown_keeps_its_prior_and_is_told(result):
    k = NAMES.index("radius exponent")  # nothing turns
    assert not result.shown[k]
    assert result.point[k] == START[k]
    (line,) = (each for each in identification.table(result).splitlines() if "radius exponent" in each)
    assert "this log does not show it" in line
    assert "this log does not show it" not in identification.table(result).splitlines()[2]  # mu_c


def test_the_residual_is_that_of_the_configuration_written(result, log):
    rows = (np.arange(len(log.command)) // log.rate).astype(int) % 4 == 3
    residual = np.sqrt(((log.readings - result.after)[rows] ** 2).mean(axis=0))
    np.testing.assert_allclose(result.held_out, residual)
    assert (result.held_out[:4] < np.std(log.readings[:, :4], axis=0)).all()


def test_the_report_asks_for_a_motion_that_turns(folder):
    report = (folder / "report.md").read_text()
    assert "20 s of **turn**" in report or "20 s of **slide and squeeze**" in report
    assert (folder / "report.png").stat().st_size > 10_000


def test_the_configuration_written_holds_what_was_found(result, folder):
    config = load(str(folder / "gripper.yaml"))
    assert config.materials["identified"].mu_c == found(result)["mu_c"]
    assert config.contact.pad.shear_compliance == found(result)["shear compliance"]
    written = yaml.safe_load((folder / "gripper.yaml").read_text())
    assert written["materials"]["identified"]["mu_c"] == found(result)["mu_c"]


@pytest.mark.slow  # programs of its own
@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_environments_run_with_the_configuration(result, folder, engine):
    config = str(folder / "gripper.yaml")
    env = gym.make("slipgym/Hold-v0", engine=engine, config=config, material="identified")
    _, info = env.reset(seed=0)
    assert info["true"][1] == pytest.approx(found(result)["mu_c"])
    assert np.isfinite(float(env.step(env.action_space.sample())[1]))
    env.close()


@pytest.mark.slow
def test_the_same_log_gives_the_same_bits(result):
    again = identify(simulated_log(GRIPPER, names=("press", "slide x")))
    assert again.point.tobytes() == result.point.tobytes()
    assert again.deviation.tobytes() == result.deviation.tobytes()


def test_a_model_that_does_not_fit_is_told(log, tmp_path):
    readings = log.readings.copy()
    readings[:, 1] += np.sin(3.0 * np.arange(len(readings)) / log.rate)  # no parameter does this
    path = tmp_path / "log.csv"
    write_log(replace(log, readings=readings), path)
    arguments = [str(path), "--contact", "disc", "--output", str(tmp_path / "out")]
    done = CliRunner().invoke(application("identify"), arguments)
    assert done.exit_code == 0, done.output
    told = "The model does not fit this log: held-out residuals over the noise are f_y"
    assert done.output.rstrip().splitlines()[-1].startswith(told)
    for name in ("report.md", "gripper.yaml"):
        assert told in (tmp_path / "out" / name).read_text()


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("force gain", 0.232, r"force gain = 0.232, 14.6 deviations from the prior 1 \(4 are 0.67 to 1.5\)"),
        ("zero f_n", -5.0, r"zero f_n = -5 N, 16.7 deviations from the prior 0 N \(4 are -1.2 to 1.2 N"),
        ("lag", 0.9, r"lag = 0.9 s, 5.8 deviations from the prior 0.015 s"),
        ("force gain", 1.4, ""),
    ],
)
def test_a_value_of_no_gripper_is_named(result, name, value, says):
    """As a command in percent gives: the model follows it, with a gain that no gripper has."""
    k, point = NAMES.index(name), result.point.copy()
    point[k] = np.log(value) if PARAMETERS[k].log else value
    found = replace(result, point=point)
    verdict, table = identification.verdict(found), identification.table(found)
    assert verdict.startswith("The model fits this log:") == (not says)
    assert re.search(says, verdict)
    assert ("unit" in verdict) == bool(says)
    (row,) = (line for line in table.splitlines() if line.startswith(f"| {name} ["))
    assert ("far from the prior" in row) == bool(says)


def test_a_log_without_slip_sensor_leaves_its_latency_alone(log):
    readings = log.readings.copy()
    readings[:, 4:] = np.nan
    result = identify(replace(log, readings=readings), "disc")
    assert not result.shown[NAMES.index("slip latency")]
    assert np.isnan(result.held_out[4:]).all()
    assert "slip" not in identification.overrides(result)["sensors"]


def test_noise_is_that_of_the_sensor_and_not_of_the_motion(log):
    np.testing.assert_allclose(log.noise(), GRIPPER.noise, rtol=0.3)
    readings = np.round(log.readings / 0.5) * 0.5
    assert replace(log, readings=readings).noise()[0] >= 0.5 / np.sqrt(12.0)


def test_velocities_that_are_held_are_read_once(log, tmp_path):
    """A sensor of 40 Hz in rows of 120 Hz: its noise is that of its samples, and the model fits."""
    readings = log.readings.copy()
    readings[:, 4:] = readings[np.arange(len(readings)) // 3 * 3, 4:]
    write_log(replace(log, readings=readings), tmp_path / "log.csv")
    read = read_log(tmp_path / "log.csv")
    there = np.isfinite(read.readings[:, 4:])
    assert there[:, 0].sum() == pytest.approx(len(readings) / 3, abs=3)
    assert (there == there[:, :1]).all()
    np.testing.assert_allclose(read.readings[there[:, 0], 4:], readings[there[:, 0], 4:], atol=1e-8)
    np.testing.assert_allclose(read.noise(), GRIPPER.noise, rtol=0.4)
    result = identify(read, "disc")
    assert not {"v_x", "v_y", "omega"} & set(result.misfits())
    identification.write(result, tmp_path)
    assert "slip" in identification.overrides(result)["sensors"]


def test_a_log_is_read_as_it_was_written(log, tmp_path):
    write_log(log, tmp_path / "log.csv")
    read = read_log(tmp_path / "log.csv")
    assert read.rate == pytest.approx(log.rate)
    np.testing.assert_allclose(read.readings, log.readings, atol=1e-8)


@pytest.mark.slow  # half a minute of log and all motions
def test_a_whole_session_shows_most_parameters():
    gripper = draw_gripper(2)
    result = identify(simulated_log(gripper, 2))
    truth = np.array([gripper.values[name] for name in NAMES])
    low, high = result.interval().T
    assert result.shown.sum() >= 15
    assert (low <= truth)[result.shown].mean() >= 0.8
    assert (truth <= high)[result.shown].mean() >= 0.8


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda f: f.rename(columns={"f_n": "Fz"}), "column f_n is missing.* it has: .*Fz"),
        (lambda f: f.drop(columns="omega"), "column omega is missing"),
        (lambda f: f.assign(f_x=np.nan), "row 1: f_x must be a finite number"),
        (lambda f: f.assign(tau="a"), "row 1: tau must be a finite number"),
        (lambda f: f.assign(t=0.0), "equal steps"),
        (lambda f: f.drop(index=range(100, 200)), "equal steps"),
        (lambda f: f.iloc[:100], "must be at least 5 s"),
        (lambda f: f.assign(force=-1.0), "force must be >= 0"),
        (lambda f: f.iloc[:0], "rows"),
        (lambda f: f[["t"]].iloc[:0].rename(columns={"t": "x"}), "column t is missing"),
    ],
)
def test_a_bad_log_is_refused(log, tmp_path, change, message):
    pandas = pytest.importorskip("pandas")
    path = tmp_path / "log.csv"
    write_log(log, path)
    change(pandas.read_csv(path)).to_csv(path, index=False)
    with pytest.raises(ValueError, match=message):
        read_log(path)
    done = CliRunner().invoke(application("identify"), [str(path), "--output", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert not (tmp_path / "out").exists()


def test_a_wrong_contact_is_refused(log):
    with pytest.raises(ValueError, match="contact"):
        identify(log, "bristle")


@pytest.mark.parametrize("rows", [0, 1, 10])
def test_a_log_of_other_shapes_is_refused(log, rows):
    with pytest.raises(ValueError, match="shapes"):
        replace(log, command=log.command[:rows])


def test_a_log_with_gaps_is_refused(log):
    for column in (0, 5):
        readings = log.readings.copy()
        readings[7, column] = np.nan
        with pytest.raises(ValueError, match="finite"):
            Log(log.rate, log.command, log.motion, readings)


@pytest.mark.parametrize(("rate", "message"), [(19.0, "rows per second"), (500.0, "at least 5 s")])
def test_a_log_too_short_or_of_another_rate_is_refused(log, rate, message):
    with pytest.raises(ValueError, match=message):
        replace(log, rate=rate)


def test_a_log_in_which_nothing_happens_is_refused(log):
    with pytest.raises(ValueError, match="never changes"):
        identify(replace(log, readings=np.zeros_like(log.readings)))
