"""Archives and pickles from a stranger: refused with words, and nothing in them runs."""

import base64
import io
import json
import os
import pickle
import zipfile
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

import policies
from estimator import records
from policies.commands import front
from policies.evaluation.one_policy import episodes
from policies.learned import files as policy_files
from policies.training import checkpoints


class Payload:
    """Writes a file when it is unpickled."""

    def __init__(self, mark):
        self.mark = str(mark)

    def __reduce__(self):
        return os.mknod, (self.mark,)


def npy(value):
    buffer = io.BytesIO()
    np.save(buffer, value, allow_pickle=True)
    return buffer.getvalue()


def npz(payload):
    buffer = io.BytesIO()
    np.savez(buffer, weights=np.array([payload], dtype=object))
    return buffer.getvalue()


def zipped(members, compression=zipfile.ZIP_STORED):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", compression) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return buffer.getvalue()


def sb3(payload):
    """The layout of Stable-Baselines3's `save`: JSON with pickles in base64, and pickles of tensors."""
    serialized = base64.b64encode(pickle.dumps(payload)).decode()
    data = {"policy_class": {":type:": "<class 'type'>", ":serialized:": serialized}}
    return zipped({"data": json.dumps(data), "policy.pth": pickle.dumps(payload)})


def torch_like(payload):
    return zipped({"archive/data.pkl": pickle.dumps(payload), "archive/version": "3"})


def with_sums(members, **keywords):
    """A checkpoint whose checksums fit: the work of someone who means it."""
    sums = {name: sha256(content).hexdigest() for name, content in members.items()}
    return zipped({**members, "sums.json": json.dumps(sums)}, **keywords)


def checkpoint(payload):
    """A whole checkpoint, one of whose arrays is of objects."""
    return with_sums({"tree.json": b'{"array": 0}', "0.npy": npy(np.array([payload], dtype=object))})


def structured(payload):
    """The same, the object in a field."""
    array = np.zeros(1, [("a", "O")])
    array[0] = (payload,)
    return with_sums({"tree.json": b'{"array": 0}', "0.npy": npy(array)})


BINARIES = {
    "pickle": pickle.dumps,
    "npz": npz,
    "torch": torch_like,
    "sb3": sb3,
    "checkpoint": checkpoint,
    "structured": structured,
}


def test_the_pickles_would_go_off(tmp_path):
    marks = [tmp_path / name for name in ("pickle", "npz", "checkpoint")]
    one, two, three = map(Payload, marks)
    pickle.loads(pickle.dumps(one))
    np.load(io.BytesIO(npz(two)), allow_pickle=True)["weights"]
    with zipfile.ZipFile(io.BytesIO(checkpoint(three))) as archive:
        np.load(archive.open("0.npy"), allow_pickle=True)
    assert all(mark.exists() for mark in marks)


@pytest.mark.parametrize("kind", BINARIES)
def test_a_checkpoint_with_a_payload_is_damaged(tmp_path, mark, kind):
    checkpoints.folder(tmp_path).mkdir()
    path = checkpoints.folder(tmp_path) / "000000000064.checkpoint"
    path.write_bytes(BINARIES[kind](Payload(mark)))
    for read in (lambda: checkpoints.read(path), lambda: checkpoints.last(tmp_path)):
        with pytest.raises(ValueError, match=r"000000000064\.checkpoint is damaged"):
            read()


@pytest.mark.parametrize("kind", BINARIES)
def test_a_payload_is_no_policy(tmp_path, mark, capsys, kind):
    path = tmp_path / "model.zip"
    path.write_bytes(BINARIES[kind](Payload(mark)))
    with pytest.raises(ValueError, match=r"model\.zip is a file; a policy is a folder"):
        policies.load(path)
    with pytest.raises(SystemExit):
        front.main(["evaluate", "--policy", str(path)])
    assert "model.zip is a file; a policy is a folder" in capsys.readouterr().err
    within = tmp_path / "policy"
    within.mkdir()
    for name in (policy_files.DESCRIPTION, policy_files.WEIGHTS):
        (within / name).write_bytes(path.read_bytes())
    with pytest.raises(ValueError, match=r"policy\.json: is no JSON|larger than"):
        policies.load(within)


@pytest.mark.parametrize("kind", BINARIES)
@pytest.mark.parametrize("name", ["log.csv", "log.csv.gz", "log.parquet", "log.pkl", "log.npz"])
def test_a_payload_is_no_record(tmp_path, mark, kind, name):
    (tmp_path / name).write_bytes(BINARIES[kind](Payload(mark)))
    with pytest.raises(ValueError, match=rf"{name}"):
        records.load(tmp_path / name)


def test_a_policy_imports_no_module_of_its_makers_choice(policy_folder, tmp_path, mark, monkeypatch):
    (tmp_path / "planted.py").write_text(f"import os; os.mknod({str(mark)!r})")
    monkeypatch.syspath_prepend(tmp_path)
    for choice in ("planted:SPECIFICATION", {"name": "planted:SPECIFICATION"}):
        arguments = {"friction_source": "estimated", "estimator": choice}
        folder = policy_folder(str(type(choice)), environment={"arguments": arguments})
        with pytest.raises(ValueError, match=r"'planted:SPECIFICATION' of its policy\.json is not"):
            list(episodes(folder, 1))
        assert len(list(episodes(folder, 1, changes={"estimator": "rls"}))) == 1


def test_an_onnx_graph_is_never_opened(tmp_path):
    """Graphs are written for robots and not read here."""
    (tmp_path / "policy.onnx").write_bytes(b"\x08\x08")
    with pytest.raises(ValueError, match=r"policy\.onnx is a file; a policy is a folder"):
        policies.load(tmp_path / "policy.onnx")
    (tmp_path / "folder").mkdir()
    (tmp_path / "policy.onnx").rename(tmp_path / "folder" / "policy.onnx")
    with pytest.raises(ValueError, match=r"is no policy: it lacks policy\.json"):
        policies.load(tmp_path / "folder")
    root = Path(policies.__file__).parent
    readers = [path.name for path in root.rglob("*.py") if "onnxruntime" in path.read_text(encoding="utf-8")]
    assert readers == []


@pytest.mark.parametrize(
    ("members", "message"),
    [
        ({"tree.json": b"[" * 100_000}, "recursion"),
        ({"tree.json": b'{"record": "Popen", "values": {"mapping": []}}'}, "Popen"),
        ({"tree.json": b'{"record": "Box", "values": {"mapping": []}}'}, "missing"),
        ({"tree.json": b'{"record": ["Box"], "values": 1}'}, ""),
        ({"tree.json": b'{"mapping": [[{"list": []}, 1]]}'}, "unhashable"),
        ({"tree.json": b'{"mapping": 3}'}, ""),
        ({"tree.json": b'{"list": 1, "tuple": 2}'}, ""),
        ({"tree.json": b'{"array": "../../etc/passwd"}'}, "npy"),
        ({"tree.json": b'{"array": 0}', "0.npy": npy(np.zeros(3))[:-1]}, ""),
        ({"tree.json": b'{"array": 0}', "0.npy": npy(np.zeros(8)).replace(b"(8,)", b"(8**9,)")}, ""),
        (
            {"tree.json": b'{"array": 0}', "0.npy": npy(np.zeros(3)).replace(b"(3,), }   ", b"(3333333,)}")},
            "",
        ),
        ({}, "tree.json"),
    ],
)
def test_a_crafted_tree_is_refused(tmp_path, members, message):
    path = tmp_path / "one.checkpoint"
    path.write_bytes(with_sums(members))
    with pytest.raises(ValueError, match=rf"one\.checkpoint is damaged: .*{message}"):
        checkpoints.read(path)


def test_a_small_file_does_not_grow(tmp_path):
    path = tmp_path / "one.checkpoint"
    path.write_bytes(with_sums({"tree.json": b'"' + bytes(10**7) + b'"'}, compression=zipfile.ZIP_DEFLATED))
    assert path.stat().st_size < 20_000
    with pytest.raises(ValueError, match=r"'tree\.json' is compressed"):
        checkpoints.read(path)


def test_sums_of_another_kind_are_refused(tmp_path):
    path = tmp_path / "one.checkpoint"
    for sums in (b"[]", b"3", b"", b'{"tree.json": 1}'):
        path.write_bytes(zipped({"tree.json": b"1", "sums.json": sums}))
        with pytest.raises(ValueError, match="is damaged"):
            checkpoints.read(path)
