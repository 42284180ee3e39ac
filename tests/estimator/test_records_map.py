"""`slipgym map` finds columns by their names, guesses units and signs, and writes what `estimate` takes."""

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from estimator import records
from estimator.records.columns import parse_columns
from estimator.records.guessing import propose
from policies.commands.map import app

FORCE, TWIST = ["f_x", "f_y", "f_n", "tau"], ["v_x", "v_y", "omega"]
LOGGER = {
    "t": ("stamp", 1e3),
    "f_x": ("Fx", 1.0),
    "f_y": ("Fy", 1.0),
    "f_n": ("Fz", -1.0),
    "tau": ("Mz", 1e3),
    "v_x": ("slip_x", 1e3),
    "v_y": ("slip_y", 1e3),
    "omega": ("slip_rate", 1.0),
}
FIELDS = {
    "t": ("time [us]", 1e6),
    "f_x": ("/left/wrench.force.x", 1e3),
    "f_y": ("/left/wrench.force.y", 1e3),
    "f_n": ("/left/wrench.force.z", 1e3),
    "tau": ("/left/wrench.torque.z", 1.0),
    "v_x": ("twist.linear.x", 1.0),
    "v_y": ("twist.linear.y", 1.0),
    "omega": ("twist.angular.z (deg/s)", 180.0 / np.pi),
}
AUTHORS = {
    "t": ("timestamp", 1e9),
    **{key: (key.replace("_", ""), 1.0) for key in FORCE},
    "v_x": ("vx", 1e6),
    "v_y": ("vy", 1e6),
    "omega": ("omega", 1.0),
}


def renamed(table, names):
    return pd.DataFrame({name: table[key] * factor for key, (name, factor) in names.items()})


@pytest.mark.parametrize("names", [LOGGER, FIELDS, AUTHORS])
def test_the_proposal_reads_the_record(table, save, names):
    path = save(renamed(table, names), "log.csv")
    read = records.load(path, parse_columns(propose(path).text(), "proposed"))
    plain = records.load(save(table, "plain.csv"))
    np.testing.assert_allclose(read.wrench, plain.wrench, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(read.twist, plain.twist, rtol=1e-9)
    np.testing.assert_allclose(read.force_t, plain.force_t, rtol=1e-9)


def test_matrices_of_two_lengths(table, tmp_path):
    forces, twists = table.dropna(subset="f_n"), table.dropna(subset="omega")
    zero = 0.0 * forces["t"]
    wrench = np.stack([forces["f_x"], forces["f_y"], forces["f_n"], zero, zero, forces["tau"]], axis=1)
    slip = twists[TWIST].to_numpy()
    path = tmp_path / "log.npz"
    np.savez(path, wrench=wrench, wrench_time=forces["t"], slip=slip, slip_time=twists["t"])
    read = records.load(path, parse_columns(propose(path).text(), "proposed"))
    np.testing.assert_array_equal(read.wrench, forces[FORCE])
    np.testing.assert_array_equal(read.twist_t, twists["t"])


def test_two_fingers_and_positions(table, save):
    frame = renamed(table, {"t": ("t", 1.0)})
    for side, turn in (("left", 1.0), ("right", -1.0)):
        for key in FORCE:
            frame[f"{side}_{key}"] = table[key] * (turn if key == "f_y" else 1.0)
    frame["pos_x"], frame["pos_y"] = table["v_x"] * 0.0, 1e3 * table["v_y"] * table["t"]
    frame["angle"] = table["omega"] * table["t"]
    frame["gripper_force"] = table["f_n"]
    path = save(frame, "log.csv")
    columns = parse_columns(propose(path).text(), "proposed")
    assert list(columns.fingers) == ["left", "right"]
    left, right = (records.load(path, each) for each in columns.fingers.values())
    np.testing.assert_array_equal(left.wrench[:, 1], -right.wrench[:, 1])
    np.testing.assert_allclose(left.twist[:, 1], 0.02, rtol=1e-6)
    assert left.grip is not None
    with pytest.raises(ValueError, match=r"the mapping is of the fingers left, right"):
        records.load(path, columns)


def test_the_command_writes_a_mapping_and_a_picture(table, save, tmp_path):
    path = save(renamed(table, LOGGER), "log.csv")
    mapping, picture = tmp_path / "columns.yaml", tmp_path / "columns.png"
    done = CliRunner().invoke(app, [str(path), "--output", str(mapping), "--plot", str(picture)])
    assert done.exit_code == 0, done.output
    assert "f_n: {column: 'Fz', unit: N, sign: -1}" in mapping.read_text()
    assert "guessed: samples are 1 apart" in done.output
    assert picture.read_bytes().startswith(b"\x89PNG")
    records.load(path, records.load_columns(mapping))


def test_what_is_missing_is_said(table, save, tmp_path):
    path = save(renamed(table, LOGGER).drop(columns="Fz").rename(columns={"Fx": "channel 3"}), "log.csv")
    done = CliRunner().invoke(app, [str(path), "--output", str(tmp_path / "columns.yaml")])
    assert done.exit_code == 1
    for words in (
        "f_x: no column was found",
        "f_n: no column was found",
        "not used: channel 3",
        "no column 'f_n'",
    ):
        assert words in done.output
    assert "# f_n: no column was found" in (tmp_path / "columns.yaml").read_text()
    done = CliRunner().invoke(
        app, [str(save(pd.DataFrame({"a": [1.0, 2.0]}), "no.csv")), "--plot", str(tmp_path / "p.png")]
    )
    assert done.exit_code == 1
    done = CliRunner().invoke(app, [str(tmp_path / "nowhere.csv")])
    assert done.exit_code == 2
    assert "no such file" in done.output
