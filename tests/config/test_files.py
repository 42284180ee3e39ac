"""How the YAML files are read."""

import re
import shutil

import pytest

from slipgym import config
from slipgym.config import files
from slipgym.config.load import _files


@pytest.fixture
def write(tmp_path):
    def write(text):
        path = tmp_path / "mine.yaml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


FAULTS = {
    "duplicate": ("object: {mass: 1, mass: 2}", "duplicate key 'mass'"),
    "duplicate at the top": ("object: {mass: 1}\nobject: {mass: 2}", "line 2"),
    "syntax": ("object: [1, 2", "line 1"),
    "list": ("- object", "must be a mapping"),
    "text": ("object", "must be a mapping"),
    "code": ("object: !!python/object/apply:os.getcwd []", "could not determine a constructor"),
    "no text": (b"\xff\xfe\xff", "mine.yaml"),
    "nan": ("object: {mass: .nan}", "object.mass = nan"),
    "infinity": ("object: {mass: -.inf}", "object.mass = -inf"),
    "unknown key": ("object: {weight: 1}", "object.weight"),
}


@pytest.mark.parametrize(("text", "said"), FAULTS.values(), ids=FAULTS.keys())
def test_a_fault_names_the_file(write, text, said):
    path = write(text)
    with pytest.raises(ValueError, match=re.escape(said)) as caught:
        config.load(path)
    assert str(caught.value).startswith(f"{path}: ")


def test_no_such_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"none\.yaml"):
        config.load(tmp_path / "none.yaml")


@pytest.mark.parametrize("text", ["1e-3", "1.0e-3", "1.e-3", "0.001", ".001", "+1E-3"])
def test_numbers_read_as_yaml_1_2_does(write, text):
    assert files.read(write(f"a: {text}")) == {"a": 1e-3}


def test_whole_numbers_stay_whole_and_quoted_ones_text(write):
    data = files.read(write('{a: 3, b: "1e-3"}'))
    assert data == {"a": 3, "b": "1e-3"}
    assert isinstance(data["a"], int)


def test_a_fault_in_a_default_file_names_that_file(tmp_path, monkeypatch):
    shutil.copytree(files.folder(), tmp_path / "configs")
    (tmp_path / "configs" / "materials.yaml").write_text("wood: {mu_c: 0.5, mu_s: 0.4}")
    monkeypatch.setattr(files, "folder", lambda: tmp_path / "configs")
    _files.cache_clear()
    try:
        with pytest.raises(ValueError, match=r"materials\.yaml: materials\.wood: needs mu_s >= mu_c"):
            config.load({"object": {"mass": 0.3}})
    finally:
        _files.cache_clear()
