"""A record says the same from any file type, from memory, and from messages with other layouts."""

import json
import struct

import numpy as np
import pandas as pd
import pytest

from estimator import records
from estimator.records import proposal
from tests.estimator import bag_files
from tests.estimator.bag_files import BAG, BAGS, FORCE, TWIST, header, two, write_mcap


def same(first, second):
    for name in ("force_t", "wrench", "twist_t", "twist", "cop", "truth"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))


def groups(table):
    """Both streams as arrays: a matrix of the wrench, in N mm where it is a torque, and the velocities."""
    forces, twists = two(table)
    wrench = np.stack([forces["f_x"], forces["f_y"], forces["f_n"], 1e3 * forces["tau"]], axis=1)
    return {
        "time": forces["t"],
        "wrench": wrench,
        "slip_time": twists["t"],
        "slip": np.stack([twists[name] for name in TWIST], axis=1),
    }


MAPPING = """
t: time
velocity_t: slip_time
f_x: wrench[0]
f_y: wrench[1]
f_n: wrench[2]
tau: {column: "wrench[3]", unit: N mm}
v_x: slip[0]
v_y: slip[1]
omega: slip[2]
"""


def npz(path, arrays):
    np.savez(path, **arrays)


def hdf5(path, arrays):
    with pytest.importorskip("h5py").File(path, "w") as file:
        for name, values in arrays.items():
            file[f"run/{name}"] = values


def mat(path, arrays):
    columns = {name: v[:, None] if v.ndim == 1 else v for name, v in arrays.items()}
    pytest.importorskip("scipy.io").savemat(path, {"run": columns})


def mat73(path, arrays):
    """As MATLAB writes it: HDF5 behind 512 bytes of its own, the axes in the other order."""
    with pytest.importorskip("h5py").File(path, "w", userblock_size=512) as file:
        for name, values in arrays.items():
            file[f"run/{name}"] = np.atleast_2d(values.T)
        file["#refs#/a"] = np.zeros(3)
    with path.open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116))


GROUPS = {"log.npz": npz, "log.h5": hdf5, "LOG.HDF5": hdf5, "log.mat": mat, "new.mat": mat73}


@pytest.mark.parametrize("name", GROUPS)
def test_arrays_of_two_lengths(table, save, tmp_path, mapping, name):
    GROUPS[name](tmp_path / name, groups(table))
    read = records.load(tmp_path / name, mapping(MAPPING))
    plain = records.load(save(table, "plain.parquet"))
    np.testing.assert_allclose(read.wrench, plain.wrench, rtol=1e-15)
    np.testing.assert_array_equal(read.force_t, plain.force_t)
    np.testing.assert_array_equal(read.twist, plain.twist)


@pytest.mark.parametrize("name", GROUPS)
def test_a_missing_column_lists_what_is_there(table, tmp_path, mapping, name):
    GROUPS[name](tmp_path / name, groups(table))
    with pytest.raises(ValueError, match=r"f_x: no column 'wrench\[9\]'; did you mean .*has: .*wrench\[0\]"):
        records.load(tmp_path / name, mapping(MAPPING.replace("f_x: wrench[0]", "f_x: wrench[9]")))


@pytest.mark.parametrize("name", [*GROUPS, "log.xlsx", "log.mcap", "log.bag", "log.db3"])
def test_a_damaged_file_is_one_error(table, tmp_path, name):
    for library in {"xlsx": ["openpyxl"], "mcap": ["mcap"], "bag": ["rosbags"], "db3": ["rosbags"]}.get(
        name.rpartition(".")[2], []
    ):
        pytest.importorskip(library)
    path = tmp_path / name
    for data in (
        b"",
        b"no such thing" * 99,
        b"\x89HDF\r\n\x1a\n",
        b"PK\x03\x04" + bytes(99),
        b"#ROSBAG V2.0\n",
    ):
        path.write_bytes(data)
        with pytest.raises(ValueError, match=rf"{name}: "):
            records.load(path)
    if name in GROUPS:
        GROUPS[name](path, groups(table))
        path.write_bytes(path.read_bytes()[:3000])
        with pytest.raises(ValueError, match=rf"{name}: "):
            records.load(path)


def test_memory_is_copied(table):
    forces, twists = ({name: values.copy() for name, values in each.items()} for each in two(table))
    record = records.from_arrays(forces, twists)
    forces["f_n"][:] = np.nan
    twists["omega"][:] = 9.0
    assert np.isfinite(record.wrench).all()
    assert record.twist[:, 2].max() < 9.0
    with pytest.raises(ValueError, match=r"arrays: cannot be read: .*inhomogeneous"):
        records.from_arrays({**forces, "f_x": [[1.0], [1.0, 2.0]]})


def test_a_sheet_is_read_as_a_csv_file(table, save, tmp_path, mapping):
    pytest.importorskip("openpyxl")
    forces, twists = two(table)
    head = pd.DataFrame([["Measurement 3"] + 4 * [None], 5 * [None], [*forces], ["s", *"NNN", "N mm"]])
    forces["tau"] = 1e3 * forces["tau"]
    body = pd.DataFrame(np.stack(list(forces.values()), axis=1))
    with pd.ExcelWriter(tmp_path / "log.xlsx") as book:
        pd.concat([head, body]).to_excel(book, sheet_name="F T", header=False, index=False)
        pd.DataFrame(twists).to_excel(book, sheet_name="slip", index=False)
    read, plain = records.load(tmp_path / "log.xlsx"), records.load(save(table, "plain.parquet"))
    np.testing.assert_allclose(read.wrench, plain.wrench, rtol=1e-14)
    np.testing.assert_array_equal(read.twist_t, plain.twist_t)


@pytest.mark.parametrize("side", [[["Operator", "Smith"], ["Gripper", "G1"]], [["mass [g]", 200]], [[1, 2]]])
def test_columns_of_a_workbook_are_named_by_their_sheet(table, save, tmp_path, mapping, side):
    """What `slipgym map` proposes can be read, beside a sheet of notes, which may have numbers alone."""
    pytest.importorskip("openpyxl")
    table = table[table["t"] < 0.2].round(9)  # the digits that a cell keeps
    with pd.ExcelWriter(tmp_path / "log.xlsx") as book:
        pd.DataFrame(side).to_excel(book, sheet_name="Info", header=False, index=False)
        table.to_excel(book, sheet_name="Data", index=False)
        table.to_excel(book, sheet_name="again", index=False)
    with pytest.raises(ValueError, match=r"f_x may be Data/f_x, again/f_x"):
        records.load(tmp_path / "log.xlsx")
    plain, names = records.load(save(table, "plain.parquet")), ("t", *FORCE, *TWIST)
    own = mapping("\n".join(f"{name}: Data/{name}" for name in names))
    same(records.load(tmp_path / "log.xlsx", own), plain)
    proposed = proposal.text_of_fingers(proposal.propose_fingers(tmp_path / "log.xlsx")[0])
    assert "f_x: {column: 'Data/f_x'" in proposed
    same(records.load(tmp_path / "log.xlsx", mapping(proposed)), plain)


def test_a_sheet_that_cannot_be_read_is_named(tmp_path):
    book = pytest.importorskip("openpyxl").Workbook()
    book.active.title = "run 3"
    for row in ([1.0, 2.0], ["1", "2"]):
        book.active.append(row)
    book.save(tmp_path / "log.xlsx")
    with pytest.raises(ValueError, match=r"log\.xlsx: .*sheet 'run 3': no line of names"):
        records.load(tmp_path / "log.xlsx")


@pytest.mark.parametrize("kind", BAGS)
def test_a_bag_gives_the_run_of_a_file(table, save, tmp_path, mapping, kind):
    read = records.load(BAGS[kind](tmp_path, table), mapping(BAG))
    plain = records.load(save(table, "plain.parquet"))
    np.testing.assert_array_equal(read.wrench, plain.wrench)
    for name in ("force_t", "twist_t"):
        np.testing.assert_allclose(getattr(read, name), getattr(plain, name), atol=1e-9)
    np.testing.assert_array_equal(read.twist, plain.twist.astype(np.float32))


def test_a_topic_that_nobody_can_read_is_said_if_it_is_asked_for(table, tmp_path, mapping):
    path = write_mcap(tmp_path / "log.mcap", table)
    with pytest.raises(ValueError, match=r"log\.mcap: cannot be read: /proto: .*lab\.Proto.*protobuf"):
        records.load(path, mapping(BAG + "cop_x: /proto.x"))
    with pytest.raises(ValueError, match=r"f_x: no column '/wrist/wrench\.wrench\.forse\.x'; did you mean"):
        records.load(path, mapping(BAG.replace("force.x", "forse.x")))


def test_a_message_that_its_definition_does_not_fit_is_refused(table, tmp_path, mapping, monkeypatch):
    monkeypatch.setattr(bag_files, "slip_message", lambda row, k, cdr=True: header(row[0], cdr).done())
    with pytest.raises(ValueError, match=r"/slip: a message is shorter than its definition"):
        records.load(write_mcap(tmp_path / "log.mcap", table), mapping(BAG))


EMPTY = "lab/A[4000] a\n" + "=" * 80 + "\nMSG: lab/A\nlab/B[4000] b\n" + "=" * 80 + "\nMSG: lab/B\n"
LOOPS = "lab/Loop[] again\n" + "=" * 80 + "\nMSG: lab/Loop\nlab/Loop inner\n"


@pytest.mark.parametrize(
    ("definition", "raw"),
    [
        (LOOPS, b"\0\1\0\0" + struct.pack("<I", 1)),
        ("float64[] x\nstring[] y", b"\0\1\0\0" + struct.pack("<I", 2**31)),
        ("string[] y", b"\0\1\0\0" + struct.pack("<I", 2**31)),
        ("lab/Nowhere x", b"\0\1\0\0" + bytes(8)),
        ("float64 x", b"\0\7\0\0" + bytes(8)),
        (EMPTY, b"\0\1\0\0" + bytes(2**20)),
        ("wstring x", b"\0\1\0\0" + bytes(8)),
    ],
)
def test_a_hostile_definition_ends_soon_with_one_error(tmp_path, definition, raw):
    writer = pytest.importorskip("mcap.writer")
    path = tmp_path / "log.mcap"
    with path.open("wb") as file:
        out = writer.Writer(file)
        out.start()
        schema = out.register_schema("lab/msg/Odd", "ros2msg", definition.encode())
        out.add_message(out.register_channel("/odd", "cdr", schema), 0, raw, 0)
        out.finish()
    with pytest.raises(ValueError, match=r"log\.mcap: "):
        records.load(path)


def test_json_and_short_names(table, save, tmp_path):
    writer = pytest.importorskip("mcap.writer")
    with (tmp_path / "log.mcap").open("wb") as file:
        out = writer.Writer(file)
        out.start()
        for topic, stream in zip(("/left", "/slip"), two(table), strict=True):
            channel = out.register_channel(topic, "json", 0)
            for row in zip(*stream.values(), strict=True):
                named = dict(zip(stream, map(float, row), strict=True))
                stamp = round(named.pop("t") * 1e9)
                out.add_message(channel, stamp, json.dumps(named).encode(), stamp)
        out.finish()
    same(records.load(tmp_path / "log.mcap"), records.load(save(table, "plain.parquet")))


def test_what_has_no_columns_is_refused(tmp_path):
    np.savez(tmp_path / "log.npz", text="a robot")
    with pytest.raises(ValueError, match=r"log\.npz: cannot be read: it has no columns of numbers"):
        records.load(tmp_path / "log.npz")


def test_a_column_of_another_topic_is_taken_only_if_the_mapping_names_it(table, tmp_path, mapping):
    forces, twists = two(table)
    arrays = {f"left/{name}": values for name, values in forces.items()}
    arrays |= {f"slip/{name}": values for name, values in twists.items()}
    arrays |= {f"right/{name}": forces[name][::2] + 0.0 for name in ("t", "f_x", "f_n")}
    arrays |= {f"right/{name}": 5.0 + 0.0 * forces["t"][::2] for name in ("tau_x", "tau_y", "grip")}
    np.savez(tmp_path / "log.npz", **arrays)
    assert records.load(tmp_path / "log.npz").cop is None
    assert records.load(tmp_path / "log.npz").grip is None
    named = records.load(tmp_path / "log.npz", mapping("grip: right/grip"))
    assert (named.grip == 5.0).all()
    assert records.from_arrays(table.assign(grip="open")).grip is None


def test_topics_that_could_both_be_meant_are_named(table, tmp_path):
    forces, twists = two(table)
    arrays = {f"left/{name}": values for name, values in forces.items()}
    arrays |= {f"right/{name}": values[::2] for name, values in forces.items()}
    np.savez(tmp_path / "log.npz", **arrays, **{f"slip/{name}": values for name, values in twists.items()})
    with pytest.raises(ValueError, match=r"f_x may be left/f_x, right/f_x; .* as `f_x: left/f_x`"):
        records.load(tmp_path / "log.npz")
