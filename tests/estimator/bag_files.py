"""Bags of ROS 1 and ROS 2 in every container; the bytes of messages are written here, not by a library."""

import struct

import numpy as np
import pytest

FORCE, TWIST = ["f_x", "f_y", "f_n", "tau"], ["v_x", "v_y", "omega"]


def two(table):
    """Name -> array of each stream."""
    forces, twists = table.dropna(subset="f_n"), table.dropna(subset="omega")
    return (
        {name: forces[name].to_numpy() for name in ("t", *FORCE)},
        {name: twists[name].to_numpy() for name in ("t", *TWIST)},
    )


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
