"""`slipgym map` finds the columns of foreign logs, their units and signs."""

import numpy as np
import pytest
from typer.testing import CliRunner

from estimator import records
from estimator.records import proposal
from policies.commands.map import app

FOREIGN = {
    "t": ("stamp", 1e3),
    "f_x": ("Fx", 1.0),
    "f_y": ("Fy", 1.0),
    "f_n": ("Fz", -1.0),
    "tau": ("Mz", 1e3),
    "v_x": ("slip_x", 1e3),
    "v_y": ("slip_y", 1e3),
    "omega": ("slip_rate [deg/s]", 180.0 / np.pi),
}
ROS = {
    "f_x": ("/ft.wrench.force.x", 1.0),
    "f_y": ("/ft.wrench.force.y", 1.0),
    "f_n": ("/ft.wrench.force.z", 1.0),
    "tau": ("/ft.wrench.torque.z", 1.0),
    "v_x": ("/slip.twist.linear.x", 1.0),
    "v_y": ("/slip.twist.linear.y", 1.0),
    "omega": ("/slip.twist.angular.z", 1.0),
}
MATRIX = {name: (f"ft[{k}]", 1.0) for k, name in enumerate(("f_x", "f_y", "f_n"))}
MATRIX |= {"t": ("time", 1.0), "tau": ("ft[5]", 1.0), "v_x": ("slip_velocity[0]", 1e3)}
MATRIX |= {"v_y": ("slip_velocity[1]", 1e3), "omega": ("omega_z", 1.0)}


@pytest.mark.parametrize("names", [FOREIGN, ROS, MATRIX], ids=["csv", "ros", "matrix"])
def test_the_record_is_that_of_the_right_mapping(table, save, tmp_path, names):
    foreign = table.rename(columns={key: name for key, (name, _) in names.items()})
    for name, factor in names.values():
        foreign[name] *= factor
    log = save(foreign.assign(joint_1=0.3, status="ok"), "foreign.csv")
    fingers, left = proposal.propose_fingers(log)
    (found,) = fingers.values()
    assert {each.key: each.column for each in found} == {"t": "t"} | {
        k: name for k, (name, _) in names.items()
    }
    assert left == ["joint_1", "status"]
    (tmp_path / "proposed.yaml").write_text(proposal.text_of_fingers(fingers))
    ours, plain = (
        records.load(log, records.load_columns(tmp_path / "proposed.yaml")),
        records.load(save(table)),
    )
    for name in ("force_t", "wrench", "twist_t", "twist"):
        np.testing.assert_allclose(getattr(ours, name), getattr(plain, name), rtol=1e-9, atol=1e-12)


def test_streams_of_two_lengths_have_two_times(table, tmp_path):
    forces, velocities = table.dropna(subset="f_n"), table.dropna(subset="omega")
    arrays = {"ft_time": forces["t"], "ft": forces[["f_x", "f_y", "f_n", "tau"]]}
    arrays |= {"slip_time": velocities["t"], "slip": velocities[["v_x", "v_y", "omega"]]}
    np.savez(tmp_path / "log.npz", **{name: values.to_numpy() for name, values in arrays.items()})
    done = CliRunner().invoke(
        app,
        [str(tmp_path / "log.npz"), "--output", str(tmp_path / "m.yaml"), "--plot", str(tmp_path / "m.png")],
    )
    assert done.exit_code == 0, done.output
    assert "readable: 2.0 s, forces at 1000 Hz, velocities at 120 Hz" in done.output
    assert (tmp_path / "m.png").read_bytes().startswith(b"\x89PNG")


def test_a_unit_of_the_file_is_proposed_and_an_unknown_one_is_left_open(table, save):
    """No magnitude decides against the file, whether a row below the header states the unit or a name."""
    path = save(table.rename(columns={"f_x": "f_x [mN]", "f_y": "f_y [lbf]"}))
    header, rows = path.read_text().split("\n", 1)
    units = ",".join({"t": "s", "tau": "N mm", "omega": "rpm"}.get(name, "") for name in header.split(","))
    path.write_text("\n".join([header, units, rows]))
    text = proposal.text_of_fingers(proposal.propose_fingers(path)[0])
    assert "f_x: {column: 'f_x [mN]', unit: 'mN'}" in text
    assert "tau: {column: 'tau', unit: 'N mm'}" in text
    assert "f_y: {column: 'f_y [lbf]'}  # unknown unit 'lbf'" in text
    assert "omega: {column: 'omega'}  # unknown unit 'rpm'" in text


def test_what_is_missing_is_said(table, save):
    log = save(table.drop(columns=["tau", "omega"]), "log.csv")
    done = CliRunner().invoke(app, [str(log)])
    assert done.exit_code == 0, done.output
    for key in ("tau", "omega"):
        assert f"# {key}: ?" in done.output


def test_a_log_that_cannot_be_read(tmp_path):
    (tmp_path / "log.npz").write_bytes(b"nothing")
    for name in ("log.npz", "none.csv"):
        done = CliRunner().invoke(app, [str(tmp_path / name)])
        assert done.exit_code == 2
        assert name in done.output
        assert "Traceback" not in done.output
