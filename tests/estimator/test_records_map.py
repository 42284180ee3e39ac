"""`slipgym map` finds two fingers, displacements and the columns of a wrench, and tells of faults."""

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from estimator import records
from policies.commands.map import app

FORCE, TWIST = ["f_x", "f_y", "f_n", "tau"], ["v_x", "v_y", "omega"]


def mapped(path, tmp_path):
    """What the command prints, and the mapping that it writes."""
    output = tmp_path / "mapping.yaml"
    done = CliRunner().invoke(app, [str(path), "--output", str(output), "--plot", str(tmp_path / "m.png")])
    assert done.exit_code == 0, done.output
    return done.output, records.load_columns(output)


@pytest.mark.quick_cases("{}_R", "/finger_1/{}")
@pytest.mark.parametrize("names", ["left_{}", "{}_R", "/finger_1/{}", "{}2"])
def test_two_fingers_and_positions(table, save, tmp_path, names):
    other = {"left_{}": "right_{}", "{}_R": "{}_l", "/finger_1/{}": "/finger_2/{}", "{}2": "{}1"}[names]
    frame = table[["t"]].copy()
    for name, turn in ((names, 1.0), (other, -1.0)):
        for key in FORCE:
            frame[name.format(key)] = table[key] * (turn if key == "f_y" else 1.0)
    frame["pos_x"], frame["pos_y"] = table["v_x"] * 0.0, 1e3 * table["v_y"] * table["t"]
    frame["angle"], frame["joint_1"] = table["omega"] * table["t"], 0.3
    output, columns = mapped(save(frame, "log.csv"), tmp_path)
    assert len(columns.fingers) == 2
    first, second = (records.load(tmp_path / "log.csv", each) for each in columns.fingers.values())
    np.testing.assert_array_equal(first.wrench[:, 1], -second.wrench[:, 1])
    np.testing.assert_allclose(first.twist[:, 1], 0.02, rtol=1e-6)
    assert "not used: joint_1" in output
    with pytest.raises(ValueError, match=r"the mapping is of the fingers \w+, \w+; a record is of one"):
        records.load(tmp_path / "log.csv", columns)


def test_the_columns_of_a_wrench(table, tmp_path):
    forces, twists = table.dropna(subset="f_n"), table.dropna(subset="omega")
    zero = 0.0 * forces["t"]
    wrench = np.stack([forces["f_x"], forces["f_y"], forces["f_n"], zero, zero, forces["tau"]], axis=1)
    path = tmp_path / "log.npz"
    slip = twists[TWIST].to_numpy()
    np.savez(path, wrench=wrench, wrench_time=forces["t"], slip=slip, slip_time=twists["t"])
    _, columns = mapped(path, tmp_path)
    read = records.load(path, columns)
    np.testing.assert_array_equal(read.wrench, forces[FORCE])
    np.testing.assert_array_equal(read.twist_t, twists["t"])


def test_faults_are_told(save, tmp_path):
    frame = pd.read_csv("examples/linear_slip_wood.csv.gz")
    forces = frame.dropna(subset="f_n")[["t", *FORCE]]
    twists = frame.dropna(subset="omega")[["t", *TWIST]]
    np.savez(
        tmp_path / "log.npz",
        **{name: forces[name] for name in forces},
        **{name: twists[name] for name in TWIST},
        slip_time=twists["t"] + 0.1,
    )
    output, _ = mapped(tmp_path / "log.npz", tmp_path)
    assert "two clocks" in output


def test_columns_that_mean_nothing(save, tmp_path):
    log = save(pd.DataFrame({"a": [1.0, 2.0]}), "log.csv")
    done = CliRunner().invoke(
        app, [str(log), "--output", str(tmp_path / "m.yaml"), "--plot", str(tmp_path / "m.png")]
    )
    assert done.exit_code == 0, done.output
    assert "slipgym estimate does not take it yet" in done.output
    assert (tmp_path / "m.png").exists()


@pytest.mark.parametrize(
    ("name", "factor"),
    [("time_ms", 1e3), ("stamp_us", 1e6), ("Timestamp_ns", 1e9), ("t_s", 1.0), ("elapsed", 1.0)],
)
def test_a_time_with_its_unit(table, save, tmp_path, name, factor):
    frame = table.assign(**{name: factor * table["t"]}).drop(columns="t")
    _, columns = mapped(save(frame, "log.csv"), tmp_path)
    np.testing.assert_allclose(
        records.load(tmp_path / "log.csv", columns).force_t, table.dropna(subset="f_n")["t"], atol=1e-9
    )


def test_names_that_end_with_their_unit(table, save, tmp_path):
    frame = pd.DataFrame({"time_ms": 1e3 * table["t"], "GripCmd_N": 5.0, "robot_vx_mm_s": 0.0})
    for name, key, factor in (
        ("Fx_N", "f_x", 1.0),
        ("Fy_N", "f_y", 1.0),
        ("F_N", "f_n", 1.0),  # a name of the normal force itself, not one that ends with a unit
        ("Tz_Nmm", "tau", 1e3),
        ("slipX_mm_per_s", "v_x", 1e3),
        ("slip_vy_mm_s", "v_y", 1e3),
        ("slipRot_deg_s", "omega", 180.0 / np.pi),
    ):
        frame[name] = factor * table[key]
    output, columns = mapped(save(frame, "log.csv"), tmp_path)
    assert "not used" not in output
    read = records.load(tmp_path / "log.csv", columns)
    np.testing.assert_allclose(read.wrench, table.dropna(subset="f_n")[FORCE], rtol=1e-9)
    np.testing.assert_allclose(read.twist, table.dropna(subset="omega")[TWIST], rtol=1e-9)
    assert "force: {column: 'GripCmd_N'" in (tmp_path / "mapping.yaml").read_text()
    assert "motion_x: {column: 'robot_vx_mm_s'" in (tmp_path / "mapping.yaml").read_text()
