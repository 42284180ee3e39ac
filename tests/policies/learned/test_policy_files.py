"""What is no policy is refused, by name, before anything in it could do harm."""

import io
import os
import pickle
import zipfile
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

import policies
from policies.learned import files, read_description
from policies.learned.description import RENAMED_COLUMNS, TRAINING, WEIGHTS


class Payload:
    """Writes a file when it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)


def npz(payload):
    buffer = io.BytesIO()
    np.savez(buffer, weights=np.array([payload], dtype=object))
    return buffer.getvalue()


def torch_like(payload):
    """The layout of torch.save: a zip with a pickle in it."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("archive/data.pkl", pickle.dumps(payload))
        archive.writestr("../../escaped", "out")
    return buffer.getvalue()


PAYLOADS = {"pickle": pickle.dumps, "npz": npz, "torch": torch_like}


@pytest.mark.parametrize("kind", PAYLOADS)
def test_a_payload_is_no_weights_and_does_not_run(policy_folder, replant, tmp_path, kind):
    folder, mark = policy_folder(), tmp_path / "executed"
    data = PAYLOADS[kind](Payload(mark))
    replant(folder, data)
    with pytest.raises(ValueError, match=r"weights\.safetensors: is no safetensors file"):
        policies.load(folder)
    assert not mark.exists()
    assert not (tmp_path / "escaped").exists()
    if kind != "torch":  # the payload would have gone off
        pickle.loads(data) if kind == "pickle" else np.load(io.BytesIO(data), allow_pickle=True)["weights"]
        assert mark.exists()


@pytest.mark.parametrize("kind", PAYLOADS)
def test_a_payload_beside_the_policy_is_never_opened(policy_folder, tmp_path, kind):
    folder, mark = policy_folder(), tmp_path / "executed"
    for name in ("__init__.py", "policy.pkl", "weights.npz", "model.zip"):
        (folder / name).write_bytes(PAYLOADS[kind](Payload(mark)))
    policies.load(folder)
    assert not mark.exists()


def test_yaml_with_python_objects_is_no_description(policy_folder, tmp_path):
    folder, mark = policy_folder(), tmp_path / "executed"
    (folder / "policy.json").write_text(f"!!python/object/apply:os.system ['touch {mark}']\n")
    with pytest.raises(ValueError, match=r"policy\.json: is no JSON"):
        policies.load(folder)
    assert not mark.exists()


@pytest.mark.parametrize("kind", PAYLOADS)
def test_a_single_file_is_no_policy(tmp_path, kind):
    (tmp_path / "model.zip").write_bytes(PAYLOADS[kind](Payload(tmp_path / "executed")))
    with pytest.raises(ValueError, match=r"model\.zip is a file; a policy is a folder"):
        policies.load(tmp_path / "model.zip")
    assert not (tmp_path / "executed").exists()


def test_a_changed_byte_is_noticed(policy_folder):
    folder = policy_folder()
    data = bytearray((folder / WEIGHTS).read_bytes())
    data[-1] ^= 1
    (folder / WEIGHTS).write_bytes(data)
    with pytest.raises(ValueError, match=r"weights\.safetensors: its SHA-256 is"):
        policies.load(folder)


def test_what_is_missing_is_named(policy_folder, tmp_path):
    folder = policy_folder()
    (folder / WEIGHTS).unlink()
    with pytest.raises(ValueError, match=r"lacks weights\.safetensors"):
        policies.load(folder)
    (tmp_path / "empty").mkdir()
    with pytest.raises(ValueError, match=r"empty is no policy: it lacks policy\.json"):
        policies.load(tmp_path / "empty")


def put(*keys, value):
    def change(values):
        for key in keys[:-1]:
            values = values[key]
        values[keys[-1]] = value

    return change


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (put("format", value=2), r"format = 2 is unknown; .* reads 1"),
        (put("format", value=True), r"format = True is unknown"),
        (put("kind", value="x"), r"unknown key 'kind'"),
        (put("files", "../../etc/passwd", value="0" * 64), r"unknown file '../../etc/passwd'"),
        (put("files", "/etc/passwd", value="0" * 64), r"unknown file '/etc/passwd'"),
        (put("files", value={}), r"'weights.safetensors' is missing"),
        (put("files", WEIGHTS, value="abc"), r"files\.weights\.safetensors = 'abc'"),
        (put("files", TRAINING, value="0" * 64), r"origin\.critic is needed with"),
        (put("environment", "id", value="os:slipgym/Hold-v0"), r"environment\.id = 'os:slipgym/Hold-v0'"),
        (put("environment", "id", value="slipgym/Hold-v0\n"), r"environment\.id"),
        (put("environment", "id", value="os:path/Hold-v0"), r"environment\.id"),
        (put("environment", "arguments", "config", value="/etc/passwd"), r"config = '/etc/passwd' must be"),
        (put("environment", "arguments", "randomization", value="a.yaml"), r"unknown randomization 'a.yaml'"),
        (put("environment", "arguments", "render_mode", value="human"), r"'render_mode' is no part"),
        (put("environment", "history", value=-1), r"environment\.history = -1"),
        (put("environment", "observation", value=[]), r"environment\.observation = \[\]"),
        (put("network", "layers", value=[8, 10**9]), r"network\.layers\.1 = 1000000000"),
        (put("network", "layers", value=[1] * 17), r"network\.layers"),
        (put("network", "kind", value="lstm"), r"memory is needed for kind 'lstm'"),
        (put("network", "activation", value="__import__"), r"'tanh', 'relu', 'elu'"),
        (put("normalisation", "epsilon", value=0.0), r"normalisation\.epsilon = 0\.0"),
        (put("normalisation", value=None), r"holds the tensor 'observation\.mean'"),
        (put("network", "layers", value=[8]), r"'layers\.1\.weight' is|holds the tensor"),
        (put("network", "layers", value=[8, 7]), r"'layers\.1\.weight' is float32 \(6, 8\), .*\(7, 8\)"),
        (put("network", "layers", value=[8, 6, 6]), r"lacks the tensor 'layers\.3\.weight'"),
    ],
)
def test_a_wrong_description_is_refused_by_name(policy_folder, rewrite, change, message):
    folder = policy_folder()
    rewrite(folder, change)
    with pytest.raises(ValueError, match=message) as refused:
        policies.load(folder)
    assert str(folder) in str(refused.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"format": 1, "format": 1}', "duplicate key 'format'"),
        ('{"format": NaN}', "NaN is no number"),
        ("[" * 100_000, "is no JSON"),
        ("[]", "format = None is unknown"),
        ('{"format": ' + "1" * 10_000 + "}", "is no JSON"),
        ("\udcff", "is no JSON"),
        (" " * (2**20 + 1), "larger than the 1048576 bytes"),
    ],
)
def test_crafted_json_is_refused(policy_folder, text, message):
    folder = policy_folder()
    (folder / "policy.json").write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(ValueError, match=message):
        read_description(folder)


def test_too_much_and_devices_are_not_read(policy_folder, monkeypatch):
    folder = policy_folder()
    monkeypatch.setitem(files._LIMITS, WEIGHTS, (folder / WEIGHTS).stat().st_size)
    policies.load(folder)
    with (folder / WEIGHTS).open("ab") as file:
        file.write(b"\0")
    with pytest.raises(ValueError, match=r"is larger than the \d+ bytes"):
        policies.load(folder)
    (folder / WEIGHTS).unlink()
    os.mkfifo(folder / WEIGHTS)
    with pytest.raises(ValueError, match="no regular file"):
        policies.load(folder)


def test_a_policy_is_written_whole_or_not_at_all(policy_folder, tmp_path):
    with pytest.raises(ValueError, match=r"lacks the tensor|is float32"):
        policy_folder("broken", weights={"layers.0.bias": np.zeros(3, np.float32)})
    assert list(tmp_path.iterdir()) == []
    folder = policy_folder()
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert set(before) == {"policy.json", WEIGHTS}
    with pytest.raises(FileExistsError):
        policy_folder(seed=1)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_the_same_policy_gives_the_same_bytes(policy_folder):
    first, second = policy_folder("a"), policy_folder("b")
    for name in ("policy.json", WEIGHTS):
        assert (first / name).read_bytes() == (second / name).read_bytes()


def test_a_file_that_is_not_there_by_agreement_is_named(policy_folder):
    with pytest.raises(ValueError, match=r"unknown file 'training\.safetensors'"):
        files.read(policy_folder(), TRAINING)


def test_columns_of_version_0_1_0_have_their_present_names(policy_folder):
    folder = policy_folder("old")
    path = folder / "policy.json"
    present = path.read_text()
    old = present
    for before, after in RENAMED_COLUMNS.items():
        assert f'"{after}"' in old
        old = old.replace(f'"{after}"', f'"{before}"')
    path.write_text(old)
    assert old != present
    policy = policies.load(folder)
    names = [column.name for column in policy.description.environment.observation]
    assert {*RENAMED_COLUMNS.values()} <= set(names)
    assert not {*RENAMED_COLUMNS} & set(names)
    env = gym.make("slipgym:slipgym/Hold-v0")
    policy.check(env)
    env.close()
