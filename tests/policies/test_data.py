"""Public sets: every file is the known one or nothing is kept; no network in any test."""

import hashlib
import urllib.error
from http.client import IncompleteRead
from io import BytesIO

import pytest
from typer.testing import CliRunner

from policies.commands.data import app
from policies.data import fetch
from policies.data.fetch import store
from policies.data.sets import SETS, Known, PublicSet, find

FILES = {"LICENSE": b"as you like\n", "some folder/a.csv": b"1,2\n"}


@pytest.fixture
def public(monkeypatch):
    made = PublicSet("toy", "two files", "owner/toy", "0123456789", "MIT", "Nobody, 2026")
    made.__dict__["files"] = {path: Known(hashlib.sha256(d).hexdigest(), len(d)) for path, d in FILES.items()}
    monkeypatch.setitem(SETS, "toy", made)
    return made


@pytest.fixture
def clone(tmp_path):
    folder = tmp_path / "clone"
    for path, data in FILES.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)
    return folder


def left(folder):
    return [path for path in folder.rglob("*") if path.is_file()] if folder.exists() else []


@pytest.mark.parametrize(
    "garbage", [b"", b"3,4\n", b"1,2\n\x00", None], ids=["empty", "same size", "longer", "gone"]
)
def test_one_wrong_file_of_a_clone_leaves_nothing(public, clone, tmp_path, garbage):
    file = clone / "some folder/a.csv"
    file.unlink() if garbage is None else file.write_bytes(garbage)
    with pytest.raises(ValueError, match=r"a\.csv"):
        store(public, tmp_path / "into/toy", clone)
    assert left(tmp_path / "into") == []


@pytest.mark.parametrize(
    "error",
    [urllib.error.URLError("no route"), TimeoutError("late"), IncompleteRead(b""), ConnectionResetError()],
)
def test_no_network_is_one_error_that_says_what_to_do(public, tmp_path, monkeypatch, error):
    def refuse(*_, **__):
        raise error

    monkeypatch.setattr(fetch.urllib.request, "urlopen", refuse)
    done = CliRunner().invoke(app, ["toy", "--into", str(tmp_path / "into")])
    assert done.exit_code == 2
    for part in ("https://github.com/owner/toy", "0123456789", "--from FOLDER"):
        assert part in done.output
    assert left(tmp_path / "into") == []


def test_another_file_from_the_network_is_refused(public, tmp_path, monkeypatch):
    monkeypatch.setattr(fetch.urllib.request, "urlopen", lambda *_, **__: BytesIO(b"<html>" * 1000))
    with pytest.raises(ValueError, match="not the known file"):
        store(public, tmp_path / "into/toy")
    assert left(tmp_path / "into") == []


def test_the_network_gives_the_files_of_the_commit(public, tmp_path, monkeypatch):
    root = f"{fetch.RAW}/owner/toy/0123456789/"
    served = {root + path.replace(" ", "%20"): data for path, data in FILES.items()}
    monkeypatch.setattr(fetch.urllib.request, "urlopen", lambda url, timeout: BytesIO(served[url]))
    assert store(public, tmp_path / "toy")
    assert {path: (tmp_path / "toy" / path).read_bytes() for path in FILES} == FILES


def test_a_set_that_is_there_is_checked_and_kept(public, clone, tmp_path):
    arguments = ["toy", "--from", str(clone), "--into", str(tmp_path)]
    first, second = (CliRunner().invoke(app, arguments) for _ in range(2))
    assert first.exit_code == second.exit_code == 0
    assert "Licence: MIT" in first.output
    assert "Nobody, 2026" in first.output
    assert "was there" in second.output
    (tmp_path / "toy/LICENSE").write_bytes(b"as I like it")
    assert CliRunner().invoke(app, arguments).exit_code == 2
    assert (tmp_path / "toy/LICENSE").read_bytes() == b"as I like it"


def test_an_unknown_set_names_the_known():
    with pytest.raises(ValueError, match=r"tug'.*pushes, silicone, tugs"):
        find("tug")


def test_every_set_is_listed_with_licence_and_whole_commit():
    listed = CliRunner().invoke(app, []).output
    for each in SETS.values():
        assert each.licence in listed
        assert each.commit in listed
        assert len(each.commit) == 40
        assert next(iter(each.files)) == "LICENSE"
        for path, known in each.files.items():
            assert len(known.sha256) == 64, path
            assert known.size > 0
