"""A record says the same from any file type, from memory, and from messages with other layouts."""

import json
import struct

import numpy as np
import pandas as pd
import pytest

from estimator import records

FORCE, TWIST = ["f_x", "f_y", "f_n", "tau"], ["v_x", "v_y", "omega"]


def same(first, second):
    for name in ("force_t", "wrench", "twist_t", "twist", "cop", "truth"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))


def two(table):
    """Name -> array of each stream."""
    forces, twists = table.dropna(subset="f_n"), table.dropna(subset="omega")
    return (
        {name: forces[name].to_numpy() for name in ("t", *FORCE)},
        {name: twists[name].to_numpy() for name in ("t", *TWIST)},
    )


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


# Messages: bytes written here, not by a library that reads them


WRENCH_STAMPED = """std_msgs/Header header
Wrench wrench
================================================================================
MSG: std_msgs/Header
# of a comment with = and text
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Wrench
Vector3 force
Vector3 torque
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
SLIP = """uint8 KIND=3
string LABEL="a # b"
std_msgs/Header header
string[] name
uint16 count 7
float32[] velocity
int16[2] spare
uint8[] picture
float32[<=9] map
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""


class Bytes:
    """Writes CDR, or the bytes of ROS 1, which has neither padding nor zeros behind texts."""

    def __init__(self, cdr):
        self.cdr, self.data = cdr, b""

    def put(self, code, *values):
        size = struct.calcsize(code)
        for value in values:
            if self.cdr:
                self.data += bytes(-len(self.data) % size)
            self.data += struct.pack("<" + code, value)
        return self

    def text(self, text):
        raw = text.encode() + b"\0" * self.cdr
        self.put("I", len(raw)).data += raw
        return self

    def done(self):
        return (b"\0\1\0\0" if self.cdr else b"") + self.data


def header(t, cdr, frame="tool"):
    out = Bytes(cdr)
    if not cdr:
        out.put("I", 9)
    nanoseconds = round(t * 1e9)
    return out.put("i" if cdr else "I", nanoseconds // 10**9).put("I", nanoseconds % 10**9).text(frame)


def wrench_message(row, cdr=True):
    t, f_x, f_y, f_n, tau = row
    return header(t, cdr).put("d", f_x, f_y, -f_n, 0.0, 0.0, tau).done()


def slip_message(row, k, cdr=True):
    """Its layout changes: the order of the joints, the length of the frame's name, and a picture."""
    t, v_x, v_y, omega = row
    names, values = ["x", "spin", "y"], [v_x, omega, v_y]
    if k % 3:
        names, values = names[::-1], values[::-1]
    out = header(t, cdr, "f" * (1 + k % 2)).put("I", 3)
    for name in names:
        out.text(name)
    out.put("H", k % 60000).put("I", 3).put("f", *values).put("h", 1, 2).put("I", 5000)
    out.data += bytes(5000)
    return out.put("I", 4).put("f", 0.5, 1.5, 2.5, k).done()


BAG = """
f_x: /wrist/wrench.wrench.force.x
f_y: /wrist/wrench.wrench.force.y
f_n: {column: /wrist/wrench.wrench.force.z, sign: -1}
tau: /wrist/wrench.wrench.torque.z
v_x: "/slip.velocity[x]"
v_y: "/slip.velocity[y]"
omega: "/slip.velocity[spin]"
"""


def messages(table, cdr=True):
    """Topic, stamp [ns] of the log, which comes later and not in order, and bytes."""
    forces, twists = (np.stack(list(stream.values()), axis=1) for stream in two(table))
    found = [("/wrist/wrench", row[0], wrench_message(row, cdr)) for row in forces]
    found += [("/slip", row[0], slip_message(row, k, cdr)) for k, row in enumerate(twists)]
    rng = np.random.default_rng(0)
    late = [(round((t + rng.uniform(0.001, 0.02)) * 1e9), topic, raw) for topic, t, raw in found]
    return sorted(late)


def ros1(definition):
    return (
        definition.replace("builtin_interfaces/Time stamp", "uint32 seq\ntime stamp")
        .partition("=" * 80 + "\nMSG: builtin")[0]
        .replace("std_msgs/Header header", "Header header")
        .replace("[<=9]", "[]")
        .replace(" 7\n", "\n")
    )


def write_mcap(path, table, cdr=True):
    writer = pytest.importorskip("mcap.writer")
    suit = (lambda text: text) if cdr else ros1
    with path.open("wb") as file:
        out = writer.Writer(file)
        out.start()
        kind = "ros2msg" if cdr else "ros1msg"
        wrench = out.register_schema("geometry_msgs/msg/WrenchStamped", kind, suit(WRENCH_STAMPED).encode())
        slip = out.register_schema("lab_msgs/msg/Slip", kind, suit(SLIP).encode())
        odd = out.register_schema("lab.Proto", "protobuf", b"\x0a")
        encoding = "cdr" if cdr else "ros1"
        channels = {
            "/wrist/wrench": out.register_channel("/wrist/wrench", encoding, wrench),
            "/slip": out.register_channel("/slip", encoding, slip),
        }
        out.add_message(out.register_channel("/proto", "protobuf", odd), 0, b"\x01", 0)
        for stamp, topic, raw in messages(table, cdr):
            out.add_message(channels[topic], stamp, raw, stamp)
        out.finish()
    return path


def write_bag1(path, table):
    rosbag1 = pytest.importorskip("rosbags.rosbag1")
    typesys = pytest.importorskip("rosbags.typesys")
    store = typesys.get_typestore(typesys.Stores.ROS1_NOETIC)
    store.register(typesys.get_types_from_msg(ros1(SLIP), "lab_msgs/msg/Slip"))
    with rosbag1.Writer(path) as bag:
        wrench = bag.add_connection("/wrist/wrench", "geometry_msgs/msg/WrenchStamped", typestore=store)
        slip = bag.add_connection("/slip", "lab_msgs/msg/Slip", typestore=store)
        for stamp, topic, raw in messages(table, cdr=False):
            bag.write(slip if topic == "/slip" else wrench, stamp, raw)
    return path


def write_bag2(path, table, storage="SQLITE3"):
    rosbag2 = pytest.importorskip("rosbags.rosbag2")
    typesys = pytest.importorskip("rosbags.typesys")
    store = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
    store.register(typesys.get_types_from_msg(SLIP.split("=" * 80)[0], "lab_msgs/msg/Slip"))
    with rosbag2.Writer(path, version=9, storage_plugin=rosbag2.StoragePlugin[storage]) as bag:
        wrench = bag.add_connection("/wrist/wrench", "geometry_msgs/msg/WrenchStamped", typestore=store)
        slip = bag.add_connection("/slip", "lab_msgs/msg/Slip", typestore=store)
        for stamp, topic, raw in messages(table):
            bag.write(slip if topic == "/slip" else wrench, stamp, raw)
    return path


BAGS = {
    "mcap": lambda folder, table: write_mcap(folder / "log.mcap", table),
    "mcap of ROS 1": lambda folder, table: write_mcap(folder / "log.mcap", table, cdr=False),
    "ROS 1": lambda folder, table: write_bag1(folder / "log.bag", table),
    "ROS 2": lambda folder, table: write_bag2(folder / "log", table),
    "ROS 2, its file": lambda folder, table: next(write_bag2(folder / "log", table).glob("*.db3")),
    "ROS 2, mcap": lambda folder, table: write_bag2(folder / "log", table, "MCAP"),
}


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
    monkeypatch.setitem(globals(), "slip_message", lambda row, k, cdr=True: header(row[0], cdr).done())
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
