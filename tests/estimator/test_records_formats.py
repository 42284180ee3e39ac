"""Arrays, DataFrames and files of other programs give the record of a csv file, and execute nothing."""

import pickle
import zipfile
from pathlib import Path

import numpy as np
import pytest

from estimator import records

pytest.importorskip("h5py")
pytest.importorskip("mcap")
pytest.importorskip("rosbags")

FORCES, VELOCITIES = ("t", "f_x", "f_y", "f_n", "tau"), ("t", "v_x", "v_y", "omega")


def streams(table):
    """Forces and velocities of a table, each without empty cells."""
    return table.dropna(subset="f_n")[list(FORCES)], table.dropna(subset="omega")[list(VELOCITIES)]


def assert_same(ours, theirs, tolerance=0.0):
    for name in ("force_t", "wrench", "twist_t", "twist"):
        np.testing.assert_allclose(getattr(ours, name), getattr(theirs, name), rtol=0, atol=tolerance)


@pytest.fixture
def plain(table, save):
    """The record as csv."""
    forces, velocities = streams(table)
    return records.load(save(forces, "f.csv"), velocity=save(velocities, "v.csv"))


def columns(forces, velocities):
    return {
        **{name: forces[name].to_numpy() for name in FORCES},
        "velocity_t": velocities["t"].to_numpy(),
        **{name: velocities[name].to_numpy() for name in VELOCITIES[1:]},
    }


def write_npz(path, arrays):
    np.savez_compressed(path, **arrays)


def write_hdf5(path, arrays):
    import h5py

    with h5py.File(path, "w") as file:
        for name, values in arrays.items():
            file[name] = values
        file["text"] = "a robot"
        file["picture"] = np.zeros((100, 100))


def write_mat(path, arrays):
    from scipy.io import savemat

    savemat(path, {**arrays, "text": "a robot"})


def test_arrays_and_frames(table, plain):
    forces, velocities = streams(table)
    assert_same(records.from_arrays(forces, velocities), plain)
    arrays = [{name: frame[name].to_numpy() for name in frame} for frame in (forces, velocities)]
    assert_same(records.from_arrays(*arrays), plain)
    assert_same(
        records.from_arrays({name: list(values) for name, values in arrays[0].items()}, arrays[1]), plain
    )
    assert_same(records.from_arrays(forces.set_index("t"), velocities), plain)
    together = records.from_arrays(table)
    assert records.estimate(together).estimates.tobytes() == records.estimate(plain).estimates.tobytes()


@pytest.mark.parametrize("fill", [0.0, 99.0])
def test_a_masked_cell_is_an_empty_one(table, plain, fill):
    masked = {name: np.ma.masked_array(cells.fillna(fill), cells.isna()) for name, cells in table.items()}
    assert_same(records.from_arrays(masked), plain)
    masked["f_x"] = np.ma.masked_where(np.arange(len(table)) == 0, masked["f_x"])
    with pytest.raises(ValueError, match="row 1: f_x is empty or NaN"):
        records.from_arrays(masked)
    masked["f_x"] = np.ma.masked_array(np.zeros(len(table), int), table["f_n"].isna())
    assert (records.from_arrays(masked).wrench[:, 0] == 0.0).all()
    with pytest.raises(ValueError, match="one shape"):
        records.from_arrays(masked | {"tau": np.ma.masked_all((3, 2))})


def test_units_and_signs_of_arrays(table, plain, mapping):
    forces, velocities = streams(table)
    there = forces.assign(t=1e3 * forces["t"], Fz=-forces["f_n"]).drop(columns="f_n")
    found = records.from_arrays(
        there,
        velocities.assign(t=1e3 * velocities["t"]),
        mapping("t: {unit: ms}\nf_n: {column: Fz, sign: -1}"),
    )
    assert_same(found, plain, 1e-9)


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda a: a | {"f_x": a["f_x"][:-1]}, "one shape"),
        (lambda a: a | {"f_x": a["f_x"][:, None]}, "one shape"),
        (lambda a: {name: a[name] for name in a if name != "tau"}, "no column 'tau'"),
        (lambda a: a | {"f_x": np.where(np.arange(len(a["f_x"])) == 3, np.nan, a["f_x"])}, "row 4: f_x"),
        (lambda a: a | {"f_x": a["f_x"] > 0.0}, "must hold numbers"),
        (lambda a: a | {"t": a["t"][::-1]}, "t"),
        (lambda a: [a], "mapping of names"),
    ],
)
def test_arrays_get_the_checks_of_a_file(table, change, match):
    forces, velocities = streams(table)
    arrays = {name: forces[name].to_numpy() for name in forces}
    with pytest.raises(ValueError, match=match) as caught:
        records.from_arrays(change(arrays), velocities, name="my gripper")
    assert "my gripper" in str(caught.value)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("end", ["npz", "h5"])
def test_columns_of_a_matrix(table, plain, mapping, tmp_path, end, turned):
    forces, velocities = streams(table)
    matrices = {
        "stamp": forces["t"].to_numpy(),
        "ft": forces[list(FORCES[1:])].to_numpy(),
        "slip_stamp": velocities["t"].to_numpy(),
        "slip": velocities[list(VELOCITIES[1:])].to_numpy(),
    }
    if turned:
        matrices = {name: values.T for name, values in matrices.items()}
    path = tmp_path / f"log.{end}"
    (write_npz if end == "npz" else write_hdf5)(path, matrices)
    names = {"t": "stamp", "velocity_t": "slip_stamp"}
    names |= {name: f"ft[{k}]" for k, name in enumerate(FORCES[1:])}
    names |= {name: f"slip[{k}]" for k, name in enumerate(VELOCITIES[1:])}
    assert_same(records.load(path, mapping("\n".join(f"{k}: '{v}'" for k, v in names.items()))), plain)


def test_structures_of_matlab_and_groups_of_hdf5(table, plain, mapping, tmp_path):
    from scipy.io import savemat

    arrays = columns(*streams(table))
    savemat(tmp_path / "log.mat", {"log": {"run": arrays}})
    write_hdf5(tmp_path / "log.h5", {f"log/run/{name}": values for name, values in arrays.items()})
    for end, between in (("mat", "."), ("h5", "/")):
        names = "\n".join(f"{name}: log{between}run{between}{name}" for name in arrays)
        assert_same(records.load(tmp_path / f"log.{end}", mapping(names)), plain)


def test_mcap_of_ros_2(table, plain, mapping, tmp_path):
    from mcap_ros2.writer import Writer

    vector = "=" * 80 + "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
    stamped = "builtin_interfaces/Time stamp\nstring frame_id\n"
    time = "=" * 80 + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
    text = f"Header header\ngeometry_msgs/Vector3 a\ngeometry_msgs/Vector3 b\nfloat64[] map\n{vector}"
    text += "=" * 80 + f"\nMSG: std_msgs/Header\n{stamped}{time}"
    forces, velocities = streams(table)
    with (tmp_path / "log.mcap").open("wb") as file:
        writer = Writer(file)
        schema = writer.register_msgdef(
            "lab_msgs/msg/Own", text.replace("Header header", "std_msgs/Header header")
        )
        for topic, frame, names in (("/ft", forces, FORCES[1:]), ("/slip", velocities, VELOCITIES[1:])):
            for k, row in enumerate(frame.to_dict("records")):
                ns = round(row["t"] * 1e9)
                values = [row[name] for name in names] + [0.0] * 2
                message = {
                    "header": {"stamp": {"sec": ns // 10**9, "nanosec": ns % 10**9}, "frame_id": ""},
                    "a": dict(zip("xyz", values[:3], strict=True)),
                    "b": dict(zip("xyz", [*values, 0.0][3:6], strict=True)),
                    "map": [1.0] * 400,
                }
                writer.write_message(topic, schema, message, log_time=k, publish_time=k)
        writer.finish()
    names = dict(
        zip((*FORCES[1:], *VELOCITIES[1:]), ("/ft.a.x", "/ft.a.y", "/ft.a.z", "/ft.b.x"), strict=False)
    )
    names |= {"v_x": "/slip.a.x", "v_y": "/slip.a.y", "omega": "/slip.a.z"}
    text = "\n".join(f"{key}: {name}" for key, name in names.items())
    assert_same(records.load(tmp_path / "log.mcap", mapping(text)), plain, 1e-12)


def write_bag(path: Path, forces, velocities, ros1):
    """WrenchStamped and TwistStamped in a bag, written by rosbags."""
    from rosbags.rosbag1 import Writer as Writer1
    from rosbags.rosbag2 import Writer as Writer2
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    kind = store.types

    def header(k, t):
        ns = round(t * 1e9)
        time = kind["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)
        more = {"seq": k} if ros1 else {}
        return kind["std_msgs/msg/Header"](stamp=time, frame_id="pad", **more)

    vector, write = kind["geometry_msgs/msg/Vector3"], store.serialize_ros1 if ros1 else store.serialize_cdr
    with Writer1(path) if ros1 else Writer2(path, version=9) as bag:
        wrenches = bag.add_connection("/ft", "geometry_msgs/msg/WrenchStamped", typestore=store)
        twists = bag.add_connection("/slip", "geometry_msgs/msg/TwistStamped", typestore=store)
        for k, (t, fx, fy, fn, tau) in enumerate(forces.itertuples(index=False)):
            wrench = kind["geometry_msgs/msg/Wrench"](force=vector(fx, fy, fn), torque=vector(0.0, 0.0, tau))
            message = kind["geometry_msgs/msg/WrenchStamped"](header=header(k, 1 + t), wrench=wrench)
            bag.write(wrenches, k, write(message, "geometry_msgs/msg/WrenchStamped"))
        for k, (t, vx, vy, omega) in enumerate(velocities.itertuples(index=False)):
            twist = kind["geometry_msgs/msg/Twist"](
                linear=vector(vx, vy, 0.0), angular=vector(0.0, 0.0, omega)
            )
            message = kind["geometry_msgs/msg/TwistStamped"](header=header(k, 1 + t), twist=twist)
            bag.write(twists, k, write(message, "geometry_msgs/msg/TwistStamped"))


BAG = """
f_x: /ft.wrench.force.x
f_y: /ft.wrench.force.y
f_n: /ft.wrench.force.z
tau: /ft.wrench.torque.z
v_x: /slip.twist.linear.x
v_y: /slip.twist.linear.y
omega: /slip.twist.angular.z
"""


@pytest.mark.parametrize("ros1", [True, False])
def test_bags(table, plain, mapping, tmp_path, ros1):
    path = tmp_path / ("log.bag" if ros1 else "log")
    write_bag(path, *streams(table), ros1)
    found = records.load(path, mapping(BAG))
    np.testing.assert_allclose(found.force_t - 1, plain.force_t, rtol=0, atol=1e-8)
    np.testing.assert_allclose(found.twist_t - 1, plain.twist_t, rtol=0, atol=1e-8)
    assert_same(found, plain, 1.0 + 1e-8)
    np.testing.assert_array_equal(found.wrench, plain.wrench)
    np.testing.assert_array_equal(found.twist, plain.twist)


class Harm:
    def __reduce__(self):
        return Path.touch, (Path("harm"),)


def test_nothing_in_a_file_is_executed(table, tmp_path, monkeypatch, mapping):
    monkeypatch.chdir(tmp_path)
    arrays = columns(*streams(table))
    objects = np.array([Harm()], dtype=object)
    np.savez(tmp_path / "log.npz", harm=objects, **arrays)
    records.load(tmp_path / "log.npz", mapping("velocity_t: velocity_t"))  # is left out
    (tmp_path / "bare.npz").write_bytes(pickle.dumps(Harm()))
    with zipfile.ZipFile(tmp_path / "named.npz", "w") as file:
        file.writestr("t.npy", pickle.dumps(Harm()))
    for name in ("bare.npz", "named.npz"):
        with pytest.raises(ValueError, match=rf"{name}: "):
            records.load(tmp_path / name)
    assert not Path("harm").exists()


def test_links_out_of_an_hdf5_file_are_not_followed(tmp_path):
    import h5py

    with h5py.File(tmp_path / "secret.h5", "w") as file:
        file["t"] = np.arange(10.0)
    with h5py.File(tmp_path / "log.h5", "w") as file:
        file["t"] = h5py.ExternalLink("secret.h5", "/t")
        file["f_x"] = np.arange(10.0)
    with pytest.raises(ValueError, match="no column 't'"):
        records.load(tmp_path / "log.h5")


def test_arrays_that_would_fill_the_memory_are_refused(tmp_path):
    import h5py

    with h5py.File(tmp_path / "log.h5", "w") as file:
        file.create_dataset("t", shape=(10**12,), dtype="f8", chunks=(10**6,), compression="gzip")
    with pytest.raises(ValueError, match="bytes"):
        records.load(tmp_path / "log.h5")


def test_a_missing_library_is_named_with_its_extra(tmp_path, monkeypatch):
    import sys

    for module, end in (
        ("h5py", "h5"),
        ("openpyxl", "xlsx"),
        ("rosbags.typesys", "bag"),
        ("mcap.reader", "mcap"),
    ):
        monkeypatch.setitem(sys.modules, module, None)
        (tmp_path / f"log.{end}").write_bytes(b"x")
        with pytest.raises(ModuleNotFoundError, match=r"pip install 'slipgym\[records\]'"):
            records.load(tmp_path / f"log.{end}")
