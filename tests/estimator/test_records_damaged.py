"""Damaged files and strange texts: one short error that names the file, whatever its reader raises."""

import bz2
import gzip
import lzma
import os
import socket

import numpy as np
import pytest

from estimator import records


def flipped(data, at):
    return data[:at] + bytes([data[at] ^ 0xFF]) + data[at + 1 :]


def packed(table, save):
    return gzip.compress(save(table, "plain.csv").read_bytes())


def parquet(table, save):
    return save(table, "plain.parquet").read_bytes()


RANDOM = np.random.default_rng(0).bytes(5000)
FILES = {
    "log.csv.gz": [
        *(lambda t, s, at=at: flipped(packed(t, s), at) for at in (2, 30, 2000, -6, -1)),
        lambda t, s: packed(t, s)[:-40],
        lambda t, s: packed(t, s) + b"more",
        lambda t, s: RANDOM,
    ],
    "log.parquet": [
        *(lambda t, s, cut=cut: parquet(t, s)[:cut] for cut in (0, 3, 500, -9)),
        *(lambda t, s, at=at: flipped(parquet(t, s), at) for at in (0, 8, -1, -7, -40)),
        lambda t, s: RANDOM,
    ],
    "log.csv": [
        lambda t, s: b"",
        lambda t, s: b"\n\n",
        lambda t, s: RANDOM,
        lambda t, s: bz2.compress(packed(t, s)),
        lambda t, s: lzma.compress(packed(t, s)),
        lambda t, s: parquet(t, s),
        lambda t, s: b"x" * 200_000 + b"\n1\n",
        lambda t, s: b"\xff" * 100_000 + b"\n1\n",
        lambda t, s: ",".join(f"c\x7f{k}" * 9 for k in range(4000)).encode() + b"\n1\n",
        lambda t, s: s(t, "plain.csv").read_text().encode("utf-16-le"),
        lambda t, s: s(t, "plain.csv").read_bytes().replace(b"\n0.5,", b"\n0.5\0,"),
        lambda t, s: s(t, "plain.csv").read_bytes().replace(b"\n0.5,", b'\n"0.5,'),
        lambda t, s: s(t, "plain.csv").read_bytes().replace(b"\n0.5,", b"\n" + b"\x7f9" * 9000 + b","),
        lambda t, s: s(t, "plain.csv").read_bytes().replace(b"\n0.5,", b"\n1" + b"0" * 400 + b","),
        lambda t, s: s(t, "plain.csv").read_bytes().split(b"\n", 1)[1],
    ],
}
CASES = [(name, k) for name, each in FILES.items() for k in range(len(each))]


@pytest.mark.parametrize(("name", "case"), CASES)
def test_a_damaged_file_is_one_short_error(table, save, tmp_path, name, case):
    (tmp_path / name).write_bytes(FILES[name][case](table, save))
    try:
        records.load(tmp_path / name)
    except ValueError as error:
        message = str(error)
        assert message.startswith(f"{name}: ")
        assert len(message) < 3500
        assert all(line.isprintable() for line in message.splitlines())
    else:  # parquet has no check sums of its pages unless it was written with them
        assert name == "log.parquet"


def test_check_sums_of_parquet_are_checked(table, tmp_path):
    path = tmp_path / "log.parquet"
    table.to_parquet(path, write_page_checksum=True, compression=None)
    path.write_bytes(flipped(path.read_bytes(), 4000))
    with pytest.raises(ValueError, match=r"log\.parquet: cannot be read"):
        records.load(path)


def test_what_is_no_file_is_named(tmp_path):
    (tmp_path / "folder.csv").mkdir()
    os.mkfifo(tmp_path / "pipe.csv.gz")
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(str(tmp_path / "s.parquet"))
        for name in ("folder.csv", "pipe.csv.gz", "s.parquet"):
            with pytest.raises(ValueError, match=rf"{name}: is no regular file"):
                records.load(tmp_path / name)
    (tmp_path / "file.csv").touch()
    for name in ("file.csv/log.csv", "x" * 300 + ".csv"):
        with pytest.raises(FileNotFoundError, match=r"no such file|too long"):
            records.load(tmp_path / name)


@pytest.mark.parametrize("text", ["f_n: {}", "f_n: {{sign: [{}]}}", "f_n: [{}]", "'{}': 1\n'{}': 2", "!{} 1"])
def test_messages_about_a_mapping_are_short(tmp_path, text):
    (tmp_path / "mapping.yaml").write_text(text.replace("{}", "\u00ad" * 900))
    (tmp_path / "log.csv").write_text("t,f_x\n1,2\n")

    def load():
        return records.load(tmp_path / "log.csv", records.load_columns(tmp_path / "mapping.yaml"))

    with pytest.raises(ValueError, match=r"mapping\.yaml|log\.csv") as caught:
        load()
    assert len(str(caught.value)) < 1200


def test_a_truth_of_zero_has_no_relative_error(table, save):
    table = table.assign(true_mu_s=0.0, true_mu_c=0.0, true_r=0.0)
    for name in ("disc", "adaptive"):
        report = records.report(records.estimate(records.load(save(table)), name))
        assert "0.000" in report
        assert "%" not in report.split("\n\n")[0]
