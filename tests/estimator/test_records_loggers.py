"""Files as loggers write them: lines above the header, units, encodings, the time as index, two fingers."""

import gzip
import re

import numpy as np
import pandas as pd
import pytest

from estimator import records

UNITS = {"t": "s", "f_x": "N", "f_y": "N", "f_n": "N", "tau": "N m", "v_x": "m/s", "v_y": "m/s"}


def same(first, second):
    for name in ("force_t", "wrench", "twist_t", "twist"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))


def units_row(text, **changed):
    header, rows = text.split("\n", 1)
    units = {**UNITS, "omega": "rad/s", **changed}
    return "\n".join([header, ",".join(f"[{units[name]}]" for name in header.split(",")), rows])


TEXTS = {
    "spaces after commas": lambda text: text.replace(",", ", "),
    "spaces on both sides": lambda text: text.replace(",", " , "),
    "comments": lambda text: "# F/T log, 2024\n# rate 1000 Hz\n" + text,
    "per cent": lambda text: "% exported\n" + text,
    "slashes": lambda text: "// exported\n\n" + text,
    "comments between rows": lambda text: text.replace("\n0.5,", "\n# grip closed\n0.5,"),
    "a commented header": lambda text: "# " + text,
    "a title": lambda text: "Measurement 3 of the left finger\n\n" + text,
    "facts": lambda text: "rate,1000,Hz\nrange,20,N\nfinger,left\n" + text,
    "units": units_row,
    "line ends of Windows": lambda text: text.replace("\n", "\r\n"),
    "sep": lambda text: "sep=;\n" + text.replace(",", ";"),
    "a text with decimal commas": lambda text: re.sub(
        r"(?m)^(?=\d)", "1,5;", "note;" + text.replace(",", ";")
    ),
}


@pytest.mark.parametrize("kind", TEXTS)
def test_a_logger_is_read(table, save, tmp_path, kind):
    path = tmp_path / "log.csv"
    path.write_bytes(TEXTS[kind](save(table).read_text()).encode())
    same(records.load(path), records.load(save(table, "plain.csv")))


def test_columns_between_spaces(table, save, tmp_path):
    names = list(table.columns)
    full = table[table["f_n"].notna()].assign(v_x=0.0, v_y=0.0, omega=0.0)
    np.savetxt(tmp_path / "log.csv", full[names].to_numpy(), header=" ".join(names), fmt="%.17g")
    same(records.load(tmp_path / "log.csv"), records.load(save(full, "plain.csv")))


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-32", "latin-1"])
@pytest.mark.parametrize("name", ["log.CSV", "LOG.CSV.GZ", "log.csv"])
def test_other_encodings_and_upper_case(table, save, tmp_path, mapping, encoding, name):
    text = "# at 20 °C\n" + save(table, "plain.csv").read_text().replace("f_x", "F µ", 1)
    data = text.encode(encoding)
    (tmp_path / name).write_bytes(gzip.compress(data) if name.endswith("GZ") else data)
    same(records.load(tmp_path / name, mapping("f_x: F µ")), records.load(tmp_path / "plain.csv"))


def test_the_row_of_units_counts(table, save, tmp_path, mapping):
    text = save(table.assign(t=1e3 * table["t"], tau=1e3 * table["tau"])).read_text()
    path = tmp_path / "log.csv"
    path.write_text(units_row(text, t="ms", tau="N·mm"))
    plain, read = records.load(save(table, "plain.csv")), records.load(path)
    np.testing.assert_allclose(read.force_t, plain.force_t, rtol=1e-12)
    np.testing.assert_allclose(read.wrench, plain.wrench, rtol=1e-12)
    path.write_text(units_row(text, t="ticks", tau="Nmm"))
    with pytest.raises(ValueError, match=r"t: unknown unit '\[ticks\]'; .*`t: \{unit: …\}`"):
        records.load(path)
    same(records.load(path, mapping("t: {unit: ms}")), read)


def test_the_unit_in_a_name_counts(table, save, mapping):
    path = save(table.assign(t=1e3 * table["t"]).rename(columns={"t": "time [ms]"}))
    read = records.load(path, mapping("t: time [ms]"))
    np.testing.assert_allclose(read.force_t, records.load(save(table, "plain.csv")).force_t, rtol=1e-12)


@pytest.mark.parametrize("unit", ["lbf", "%", "?", "-", "raw", "left"])
@pytest.mark.parametrize("place", ["row", "name"])
def test_an_unknown_unit_is_refused_unless_the_mapping_states_it(table, save, mapping, unit, place):
    path, name = save(table, "plain.csv"), f"f_n [{unit}]" if place == "name" else "f_n"
    plain, text = records.load(path), path.read_text().replace("f_n", name, 1)
    path.write_text(units_row(text, f_n=unit) if place == "row" else text)
    with pytest.raises(ValueError, match=r"plain\.csv: f_n.*: unknown unit .*valid: N, mN, kN; .*scale: …"):
        records.load(path, mapping(f"f_n: '{name}'"))
    same(records.load(path, mapping(f"f_n: {{column: '{name}', unit: N}}")), plain)
    scaled = records.load(path, mapping(f"f_n: {{column: '{name}', scale: 2}}"))
    np.testing.assert_array_equal(scaled.wrench[:, 2], 2.0 * plain.wrench[:, 2])


@pytest.mark.parametrize(("key", "name"), [("f_n", "Fz [1]"), ("f_n", "Fz []"), ("t", "time (sec)")])
def test_a_place_is_no_unit_and_seconds_have_long_names(table, save, mapping, key, name):
    path = save(table.rename(columns={key: name}))
    same(records.load(path, mapping(f"{key}: '{name}'")), records.load(save(table, "plain.csv")))


def test_a_column_of_dates_states_its_unit_itself(table, save, mapping):
    dates = pd.to_datetime(1.7e9 + table["t"], unit="s")
    path = save(table.assign(**{"Time (UTC)": dates}).drop(columns="t"), "log.parquet")
    read = records.load(path, mapping("t: Time (UTC)"))
    np.testing.assert_allclose(np.ptp(read.force_t), np.ptp(table["t"][table["f_n"].notna()]), atol=1e-6)


def test_a_name_with_spaces_may_be_mapped(table, save, mapping):
    path = save(table.rename(columns={"f_x": " f_x "}), "log.parquet")
    same(records.load(path, mapping('f_x: " f_x"')), records.load(save(table, "plain.parquet")))


@pytest.mark.parametrize("ending", [".parquet", ".PARQUET"])
def test_the_time_may_be_the_index(table, tmp_path, mapping, ending):
    plain, path = tmp_path / "plain.parquet", tmp_path / f"log{ending}"
    table.to_parquet(plain)
    table.set_index("t").to_parquet(path)
    same(records.load(path), records.load(plain))
    table.set_index("t").rename_axis(None).to_parquet(path)
    with pytest.raises(ValueError, match="no column 't'; it has: index, f_x"):
        records.load(path)
    same(records.load(path, mapping("t: index")), records.load(plain))
    table.set_index("t", drop=False).to_parquet(path)
    with pytest.raises(ValueError, match="'t' is the name of columns 1 and 2"):
        records.load(path)


def two_fingers(table, names):
    fingers = [table.assign(finger=names[0]), table.assign(finger=names[1], f_y=-table["f_y"])]
    return pd.concat(fingers).sort_values("t", kind="stable")


@pytest.mark.parametrize(("names", "said"), [((1, 2), 2), (("left", "right"), "right"), ((1.0, 2.0), "'2'")])
@pytest.mark.parametrize("name", ["log.csv", "log.parquet"])
def test_rows_of_two_fingers(table, save, mapping, names, said, name):
    path = save(two_fingers(table, names), name)
    with pytest.raises(ValueError, match=r"row 2: .* repeats .* `rows: \{finger: 1\}` in the mapping"):
        records.load(path)
    plain = records.load(save(table.assign(f_y=-table["f_y"]), "plain.parquet"))
    same(records.load(path, mapping(f"rows: {{finger: {said}}}")), plain)
    with pytest.raises(ValueError, match=r"no row has finger = thumb; it has: "):
        records.load(path, mapping("rows: {finger: thumb}"))
    with pytest.raises(ValueError, match=r"rows: no column 'side'; it has: t, f_x"):
        records.load(path, mapping("rows: {side: left}"))


def test_faults_are_named_by_the_rows_of_the_file(table, save, mapping):
    both = two_fingers(table, (1, 2)).reset_index(drop=True)
    both.loc[7, "f_n"] = np.nan
    with pytest.raises(ValueError, match=r"row 8: f_n is empty"):
        records.load(save(both), mapping("rows: {finger: 2}"))


def test_a_file_of_velocities_may_hold_one_finger(table, save, mapping):
    forces = two_fingers(table[table["f_n"].notna()], (1, 2))
    velocity = save(table.dropna(subset="omega")[["t", "v_x", "v_y", "omega"]], "velocity.csv")
    record = records.load(save(forces), mapping("rows: {finger: 1}"), velocity)
    np.testing.assert_array_equal(record.wrench, records.load(save(table, "plain.csv")).wrench)
