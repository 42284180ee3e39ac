"""Spreadsheets of other countries, and headers that do not fit their rows."""

import gzip

import numpy as np
import pytest

from estimator import records
from estimator.records.sources import read_columns

FORCE, TWIST = ("f_x", "f_y", "f_n", "tau"), ("v_x", "v_y", "omega")


def rewritten(path, separator, point, end="\n"):
    """The file with another separator and decimal sign."""
    text = path.read_text().replace(".", "\0").replace(",", separator).replace("\0", point)
    path.write_text(text.replace("\n", end))
    return path


def same(first, second):
    for name in ("force_t", "wrench", "twist_t", "twist"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))


@pytest.mark.parametrize(("separator", "point"), [(";", ","), (";", "."), ("\t", ","), ("\t", ".")])
def test_other_separators_and_decimal_commas(table, save, separator, point):
    plain = records.load(save(table))
    same(records.load(rewritten(save(table, "other.csv"), separator, point)), plain)


def test_a_packed_file_with_a_byte_order_mark(table, save, tmp_path):
    text = rewritten(save(table), ";", ",").read_text()
    (tmp_path / "log.csv.gz").write_bytes(gzip.compress(text.encode("utf-8-sig")))
    same(records.load(tmp_path / "log.csv.gz"), records.load(save(table, "plain.csv")))


@pytest.mark.parametrize("fault", ["decimal commas between commas", "a separator at the end"])
def test_rows_longer_than_the_header_are_refused(table, save, fault):
    path = save(table.dropna(subset=["f_n", "omega"]))
    if fault.startswith("decimal"):
        rewritten(path, ",", ",")
    else:
        header, rows = path.read_text().split("\n", 1)
        path.write_text(header + "\n" + rows.replace("\n", ",\n"))
    with pytest.raises(ValueError, match=r"more cells than its header has names \(8\); .* semicolons"):
        records.load(path)


@pytest.mark.parametrize("names", [None, "t f_x f_y f_n tau v_x v_y omega"])
@pytest.mark.parametrize("at", [2, 150, 1500])
def test_a_longer_row_is_refused_wherever_it_is(table, save, at, names):
    """Also behind comments and empty lines; an empty cell at the end of a row shifts nothing."""
    path = save(table[["t", *FORCE, *TWIST]], "plain.csv")
    header, *rows = path.read_text().splitlines()
    if names:
        header, rows = names, [" ".join(cell or "nan" for cell in row.split(",")) for row in rows]
    comma = "," if names is None else " "
    rows[0] = f"# note{12 * ',1'}\n\n{rows[0]}"
    rows[3] += comma
    path.write_text("\n".join([header, *rows]))
    records.load(path)
    read_columns(path)
    rows[at - 1] += f"{comma}7"
    path.write_text("\n".join([header, *rows]))
    with pytest.raises(ValueError, match=rf"row {at} has more cells .* \(8\); .* semicolons"):
        records.load(path)


def test_decimal_commas_behind_whole_numbers_are_refused(table, save):
    path = save(table.dropna(subset=["f_n", "omega"]))
    header, *rows = path.read_text().splitlines()
    rows = [row.replace(".", ",") for row in rows]
    path.write_text("\n".join([header, *["0,0,0,3,0,0,0,0"] * 300, *rows]))
    with pytest.raises(ValueError, match=r"row 301 has more cells than its header has names \(8\)"):
        records.load(path)


def test_a_column_that_is_there_twice_is_refused(table, save, tmp_path):
    path = save(table)
    path.write_text(path.read_text().replace("t,f_x,f_y", "t,f_x,f_x", 1))
    with pytest.raises(ValueError, match=r"log\.csv: 'f_x' is the name of columns 2 and 3; rename"):
        records.load(path)
    (tmp_path / "mapping.yaml").write_text("f_x: force")
    path.write_text(path.read_text().replace("t,f_x,f_x", "t,force,force", 1))
    with pytest.raises(ValueError, match="'force' is the name of columns 2 and 3"):
        records.load(path, records.load_columns(tmp_path / "mapping.yaml"))


def test_a_column_that_is_not_read_may_be_there_twice(table, save):
    path = save(table.assign(status=0, state=0))
    path.write_text(path.read_text().replace("status,state", "status,status", 1))
    same(records.load(path), records.load(save(table, "plain.csv")))
