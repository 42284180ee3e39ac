"""Logs of hidden grippers give their parameters back, and say what they do not show."""

import gymnasium as gym
import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

import slipgym  # noqa: F401
from policies.commands.front import application
from slipgym import identification
from slipgym.identification import draw_gripper, identify, read_log, simulated_log, write_log
from slipgym.identification.fit import value
from slipgym.identification.parameters import NAMES, START


@pytest.fixture(scope="module")
def log():
    return simulated_log(draw_gripper(0), names=("press", "slide x", "slide y"))


@pytest.fixture(scope="module")
def result(log):
    return identify(log)


def test_known_parameters_are_recovered(result):
    truth = draw_gripper(0).values
    for name, tolerance in (("mu_c", 0.03), ("force gain", 0.01), ("lag", 0.1), ("shear compliance", 0.1)):
        assert value(result, name) == pytest.approx(truth[name], rel=tolerance), name
    assert value(result, "zero f_n") == pytest.approx(truth["zero f_n"], abs=0.02)
    np.testing.assert_allclose(result.noise, draw_gripper(0).noise, rtol=0.3)


def test_what_is_not_shown_keeps_its_prior_and_is_told(result):
    k = NAMES.index("radius exponent")  # nothing turns
    assert not result.shown[k]
    assert result.point[k] == START[k]
    (line,) = (each for each in identification.table(result).splitlines() if "radius exponent" in each)
    assert "this log does not show it" in line


def test_the_next_motion_is_one_that_turns(result, tmp_path):
    identification.write(result, tmp_path)
    report = (tmp_path / "report.md").read_text()
    assert "20 s of **turn**" in report or "20 s of **slide and squeeze**" in report
    assert (tmp_path / "report.png").stat().st_size > 10_000


def test_an_environment_takes_the_configuration(result, tmp_path):
    identification.write(result, tmp_path)
    path = tmp_path / "gripper.yaml"
    env = gym.make("slipgym/Hold-v0", config=str(path))
    env.reset(seed=0, options={"material": "identified"})
    assert not np.isnan(env.step(env.action_space.sample())[1])
    env.close()
    assert yaml.safe_load(path.read_text())["materials"]["identified"]["mu_c"] == value(result, "mu_c")


def test_the_same_log_gives_the_same_bits():
    log = simulated_log(draw_gripper(1), names=("press",))
    result, again = identify(log), identify(log)
    assert again.point.tobytes() == result.point.tobytes()
    assert again.deviation.tobytes() == result.deviation.tobytes()


def test_a_log_is_read_as_it_was_written(log, tmp_path):
    write_log(log, tmp_path / "log.csv")
    read = read_log(tmp_path / "log.csv")
    assert read.rate == pytest.approx(log.rate)
    np.testing.assert_allclose(read.readings, log.readings, atol=1e-8)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda f: f.drop(columns="f_n"), "column f_n is missing"),
        (lambda f: f.drop(columns="omega"), "column omega is missing"),
        (lambda f: f.assign(f_x=np.nan), "row 1: f_x must be a finite number"),
        (lambda f: f.assign(tau="a"), "row 1: tau must be a finite number"),
        (lambda f: f.assign(t=0.0), "equal steps"),
        (lambda f: f.drop(index=range(100, 200)), "equal steps"),
        (lambda f: f.iloc[:100], "must be at least 5 s"),
        (lambda f: f.assign(force=-1.0), "force must be >= 0"),
        (lambda f: f.iloc[:0], "rows"),
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
