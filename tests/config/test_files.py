"""How the YAML files are read."""

import os
import re
import shutil
import time
from pathlib import Path

import pytest

from slipgym import config
from slipgym.config import files, load
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


def bomb(levels):
    """Each level stands for three times the one before: 3^levels values."""
    lines = [f"a{k}: &a{k} {{p: *a{k - 1}, q: *a{k - 1}, r: *a{k - 1}}}" for k in range(1, levels)]
    return "\n".join(["a0: &a0 {x: 1}", *lines])


def merges(levels):
    return "\n".join(
        [
            "m0: &m0 {a: 1}",
            *(f"m{k}: &m{k} {{<<: [{', '.join([f'*m{k - 1}'] * 9)}]}}" for k in range(1, levels)),
        ]
    )


HEAVY = {
    "aliases": (bomb(18), "values, aliases included"),
    "merges": (merges(9), "values, aliases included"),
    "itself": ("object: &a {mass: *a}", "it refers to itself"),
    "itself in a list": ("object: &a [[*a]]", "it refers to itself"),
    "deep": ("object: " + "[" * 20_000 + "]" * 20_000, "nested deeper than 64 levels"),
    "deep mappings": ("\n".join(" " * k + f"a{k}:" for k in range(1000)), "nested deeper than 64 levels"),
    "deep by aliases": (
        "\n".join(["a0: &a0 [1]", *(f"a{k}: &a{k} [*a{k - 1}]" for k in range(1, 100))]),
        "deeper",
    ),
    "date": ("object: {mass: 2020-99-99}", "month must be in 1..12"),
    "time": ("object: {mass: 2020-01-01T99:00:00Z}", "hour must be in 0..23"),
    "digits": ("object: {mass: " + "9" * 5000 + "}", "a number has at most 100 characters"),
    "binary digits": ("object: {mass: 0b" + "1" * 100_000 + "}", "a number has at most 100 characters"),
    "sixties": ("object: {mass: 1:2:" + "59:" * 2000 + "0}", "a number has at most 100 characters"),
    "no digits": ("object: {mass: 0x_}", "invalid literal"),
    "no date": ("object: {mass: !!timestamp soon}", "line 1"),
    "no truth": ("object: {mass: !!bool perhaps}", "line 1"),
    "no number": ("object: {mass: !!float much}", "could not convert"),
    "keys": ("\n".join(f"key{k}: 1" for k in range(20_000)), "more than 20000 values"),
    "fewer keys": ("\n".join(f"key{k}: 1" for k in range(5_000)), "... and 4990 more"),
    "long key": ("? " + "k" * 100_000 + "\n: 1", "unknown key"),
    "bytes": ("# " + "x" * 2**20, "is larger than the 1048576 bytes allowed"),
}


@pytest.mark.parametrize(("text", "said"), HEAVY.values(), ids=HEAVY.keys())
def test_what_is_heavy_is_refused_shortly_and_soon(write, text, said):
    path, start = write(text), time.process_time()
    with pytest.raises(ValueError, match=re.escape(said)) as caught:
        config.load(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert len(str(caught.value)) < 4000
    assert time.process_time() - start < 5.0


def test_what_is_no_file_is_refused_at_once(tmp_path):
    pipe = tmp_path / "pipe.yaml"
    os.mkfifo(pipe)
    for path in (pipe, tmp_path, Path("/dev/zero")):
        with pytest.raises(ValueError, match="is no regular file"):
            files.read(path)


def test_aliases_of_bearable_size_are_read(write):
    assert files.read(write("a: &a {x: 1}\nb: *a\nc: {<<: *a, y: 2}"))["c"] == {"x": 1, "y": 2}


def test_mappings_that_hold_themselves_are_refused():
    values = {"mass": 1.0}
    values["object"] = values
    with pytest.raises(ValueError, match="config argument: is nested deeper than 64 levels"):
        config.load(values)
    with pytest.raises(ValueError, match="randomization argument: holds more than 20000 values"):
        config.load_randomization({"friction_scale": [0.0] * 30_000})
    with pytest.raises(ValueError, match=r"object\.mass = a very large int"):
        config.load({"object": {"mass": 10**5000}})


def test_a_name_that_no_file_can_have_is_missing():
    with pytest.raises(FileNotFoundError, match="a path of 1000 characters is too long"):
        load("x" * 1000)
