"""What a record or a mapping cannot be, and what the message says."""

import sys

import numpy as np
import pytest

from estimator import records

FORCE, TWIST = ["f_x", "f_y", "f_n", "tau"], ["v_x", "v_y", "omega"]


def scaled(name, factor):
    return lambda table: table.assign(**{name: factor * table[name]})


def with_cell(name, stream, value):
    """Puts a value into a cell of the stream's third row."""

    def change(table):
        row = np.flatnonzero(table[stream].notna())[2]
        table = table.astype({name: object})
        table.loc[row, name] = value
        return table

    return change


def repeated(table):
    table.loc[5, "t"] = table.loc[4, "t"]
    return table


def turned(table):
    table.loc[5, "t"] = 0.0005
    return table


CASES = {
    "missing column": (
        lambda t: t.rename(columns={"f_n": "F_N"}),
        r"'f_n'; did you mean 'F_N'\? it has: t, f_x",
    ),
    "missing columns name the keys": (lambda t: t.drop(columns="tau"), r"keys: t, .*cop_x.*true_r"),
    "force in mN": (scaled("f_n", 1e3), r"median of f_n is .* in mN\? `f_n: \{unit: mN\}`"),
    "velocity in mm/s": (scaled("v_y", 1e3), r"row \d+: v_y = 20 m/s.* in mm/s\?"),
    "rate in deg/s": (scaled("omega", 180.0), r"omega = 300 rad/s.* in deg/s\?"),
    "torque in N mm": (scaled("tau", 1e3), r"tau reaches .* in N mm\?"),
    "time in ms": (scaled("t", 1e3), r"force samples are 1 s apart; is the time in ms\? `t: \{unit: ms\}`"),
    "time in us": (scaled("t", 1e6), r"1000 s apart; is the time in us\? `t: \{unit: us\}`"),
    "time in ns": (scaled("t", 1e9), r"is the time in ns\? `t: \{unit: ns\}`"),
    "time in min": (scaled("t", 1 / 60), r"1\.667e-05 s apart; convert it to s, ms, us, ns"),
    "slow forces": (scaled("t", 200.0), r"0\.2 s apart; .* if it is in s, `t: \{unit: s\}`"),
    "one peak": (with_cell("f_y", "f_n", 65535.0), r"row 3: f_y = 6\.5\d+e\+04 N, above 20000"),
    "tangential force in mN": (scaled("f_y", 1e3), r"median of f_y .* in mN\? `f_y: \{unit: mN\}`"),
    "CoP in mm": (lambda t: t.assign(cop_x=3.0, cop_y=1.0), r"CoP is .* in mm"),
    "sign of the normal force": (scaled("f_n", -1.0), r"negative throughout .* `f_n: \{sign: -1\}`"),
    "repeated time": (
        repeated,
        r"row 6: the time 0\.005 s repeats the 0\.005 s of row 5; if its rows are of two fingers, `rows: \{",
    ),
    "clock that starts again": (
        lambda t: t.assign(t=t["t"].where(t["t"] < 1.0, t["t"] - 1.0)),
        r"row \d+: the time 0 s goes back .* where a counter wraps or a second record begins",
    ),
    "unsorted time": (turned, r"row 6: the time 0\.0005 s goes back from the 0\.005 s of row 5"),
    "missing time": (with_cell("t", "omega", None), r"row \d+: the time is missing"),
    "missing force": (
        with_cell("f_x", "f_n", None),
        r"row 3: f_x is empty or NaN; a row holds all of a stream",
    ),
    "missing velocity": (with_cell("v_x", "omega", None), r"row \d+: v_x is empty or NaN"),
    "text": (with_cell("f_x", "f_n", "high"), r"row 3: f_x = high is not a finite number"),
    "infinite": (with_cell("f_x", "f_n", np.inf), r"row 3: f_x = inf is not a finite number"),
    "one velocity": (lambda t: t.loc[t["t"] < 0.0125], r"1 velocity samples; at least 2"),
    "no forces": (lambda t: t.loc[t["omega"].notna() & t["f_n"].isna()], r"0 force samples; at least 2"),
    "half a CoP": (lambda t: t.assign(cop_x=0.0), r"cop_x without cop_y"),
    "two CoPs": (
        lambda t: t.assign(cop_x=0.0, cop_y=0.0, tau_x=0.0, tau_y=0.0),
        r"both cop_x and cop_y and tau_x",
    ),
    "lost CoP": (
        lambda t: t.assign(cop_x=0.0 * t["t"].where(t["t"] != 0.003), cop_y=0.0),
        r"row 3: cop_x or cop_y is empty or NaN",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_a_wrong_record_is_explained(table, save, case):
    change, message = CASES[case]
    with pytest.raises(ValueError, match=message):
        records.load(save(change(table)))


def test_a_cop_may_be_missing_out_of_contact(table, save):
    free = table["t"] < 0.1
    table = table.assign(
        f_n=table["f_n"].mask(free & table["f_n"].notna(), 0.0),
        cop_x=table["t"].where(~free) * 0.0 + 0.001,
        cop_y=0.0,
    )
    cop = records.load(save(table)).cop
    assert cop is not None
    np.testing.assert_array_equal(cop[[0, -1]], [[0.0, 0.0], [0.001, 0.0]])


def test_empty_cells_are_for_one_file_only(table, save):
    path = save(table)
    with pytest.raises(ValueError, match=r"row 9: f_x is empty or NaN$"):
        records.load(path, velocity=path)


def test_clocks_that_do_not_meet(table, save):
    later = table.dropna(subset="omega").assign(t=lambda frame: frame["t"] + 100.0)
    record = records.load(save(table.dropna(subset="f_n")), velocity=save(later, "velocity.csv"))
    with pytest.raises(
        ValueError, match=r"0 velocity samples have a force .* velocities 100\.008333 to 102 s"
    ):
        records.estimate(record)


def test_unknown_file_types_and_files(tmp_path):
    (tmp_path / "log.docx").touch()
    (tmp_path / "log.parquet").write_text("no parquet")
    (tmp_path / "log.csv").touch()
    with pytest.raises(ValueError, match=r"unknown file type; records are \.csv, \.csv\.gz, \.parquet"):
        records.load(tmp_path / "log.docx")
    for name in ("log.parquet", "log.csv"):
        with pytest.raises(ValueError, match=f"{name}: cannot be read"):
            records.load(tmp_path / name)
    with pytest.raises(FileNotFoundError, match="no such file"):
        records.load(tmp_path / "nowhere.csv")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("f_N: Fz", r"unknown key 'f_N'; did you mean 'f_n'\?"),
        ("f_n: {colum: Fz}", r"f_n: unknown key 'colum'; did you mean 'column'\?"),
        ("f_n: {unit: Newton}", r"f_n: unknown unit 'Newton'; .*valid: N, mN, kN"),
        ("f_n: {unit: [N]}", r"unknown unit \['N'\]"),
        ("f_n: {sign: -2}", r"sign = -2 must be 1 or -1"),
        ("f_n: 3", r"3 must be the name of a column"),
        ("f_n: null", r"None must be the name of a column"),
        ("- f_n", r"must be a mapping"),
        ("f_n: [", r"mapping\.yaml: "),
        ("f_n: !!int ''", r"mapping\.yaml: "),
        ("f_n: !!float ''", r"mapping\.yaml: "),
        ("f_n: !!timestamp x", r"mapping\.yaml: "),
        ('f_n: "\\UFFFFFFFF"', r"mapping\.yaml: "),
        ("rows: 1", r"rows: 1 must be a column and its value .* `rows: \{finger: 1\}`"),
        ("rows: {finger: [1]}", r"rows: \{'finger': \[1\]\} must be a column"),
    ],
)
def test_a_wrong_mapping_is_explained(tmp_path, text, message):
    path = tmp_path / "mapping.yaml"
    path.write_text(text)
    with pytest.raises(ValueError, match=message):
        records.load_columns(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [("cop_x: where_x", r"cop_x: no column 'where_x'"), ("velocity_t: stamp", r"give --velocity")],
)
def test_what_a_mapping_names_must_be_there(table, save, tmp_path, text, message):
    (tmp_path / "mapping.yaml").write_text(text)
    with pytest.raises(ValueError, match=message):
        records.load(save(table), records.load_columns(tmp_path / "mapping.yaml"))


def test_settings_are_numbers_where_they_can_be():
    parsed = records.parse_settings(["heuristic=false", "eps_v=1e-3", "n_a=3"])
    assert parsed == {"heuristic": False, "eps_v": 1e-3, "n_a": 3}
    with pytest.raises(ValueError, match="must be name=value"):
        records.parse_settings(["heuristic"])


def test_a_missing_extra_says_how_to_install_it(table, save, monkeypatch):
    path = save(table)
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ModuleNotFoundError, match=r"pip install 'slipgym\[cli\]'"):
        records.load(path)
