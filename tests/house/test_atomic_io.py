"""Files and folders are written whole or not at all."""

import os
import re
import stat
from pathlib import Path

import pytest

from slipgym import atomic_io


def test_a_file_replaces_the_old_one(tmp_path):
    for content in (b"old", b"new"):
        atomic_io.write(tmp_path / "file", content)
        assert (tmp_path / "file").read_bytes() == content
    assert os.listdir(tmp_path) == ["file"]


@pytest.mark.parametrize("call", ["fsync", "replace"])
def test_a_failure_leaves_the_old_file_and_no_other(tmp_path, monkeypatch, call):
    atomic_io.write(tmp_path / "file", b"old")

    def full(*_, **__):
        raise OSError("disk full")

    monkeypatch.setattr(os, call, full)
    with pytest.raises(OSError, match="disk full"):
        atomic_io.write(tmp_path / "file", b"new")
    assert os.listdir(tmp_path) == ["file"]
    assert (tmp_path / "file").read_bytes() == b"old"


@pytest.mark.skipif(os.name == "nt", reason="Windows has no folders to flush")
def test_the_folder_is_flushed_after_the_file_took_its_place(tmp_path, monkeypatch):
    flushed, fsync = [], os.fsync

    def noted(descriptor):
        kind = "folder" if stat.S_ISDIR(os.fstat(descriptor).st_mode) else "file"
        flushed.append((kind, (tmp_path / "made").exists()))
        fsync(descriptor)

    def folder():
        with atomic_io.new_folder(tmp_path / "made") as path:
            (path / "a").write_text("a")

    def file():
        with atomic_io.new_file(tmp_path / "made") as path:
            path.write_text("a")

    monkeypatch.setattr(os, "fsync", noted)
    for write, expected in (
        (lambda: atomic_io.write(tmp_path / "made", b"a"), [("file", False), ("folder", True)]),
        (file, [("file", True), ("folder", True)]),
    ):
        flushed.clear()
        write()
        assert flushed == expected
    (tmp_path / "made").unlink()
    flushed.clear()
    folder()
    assert flushed == [("file", False), ("folder", False), ("folder", True)]


def test_a_block_that_fails_leaves_nothing(tmp_path):
    for make in (atomic_io.new_file, atomic_io.new_folder):

        def fail(make=make):
            with make(tmp_path / "made"):
                raise RuntimeError("midway")

        with pytest.raises(RuntimeError, match="midway"):
            fail()
    assert os.listdir(tmp_path) == []


def test_a_file_keeps_its_suffixes_and_the_usual_permissions(tmp_path):
    with atomic_io.new_file(tmp_path / "deep" / "a.csv.gz") as path:
        assert path.name == "a.csv.gz"
        path.touch()
    plain = tmp_path / "plain"
    plain.touch()
    atomic_io.write(tmp_path / "written", b"")
    modes = {stat.S_IMODE(path.stat().st_mode) for path in (plain, tmp_path / "written")}
    assert len(modes) == 1


def test_a_folder_takes_nobodys_place(tmp_path):
    with pytest.raises(FileExistsError), atomic_io.new_folder(Path(tmp_path)):
        pass


def test_new_files_take_their_places_together_or_not_at_all(tmp_path):
    def fail():
        with atomic_io.new_files(tmp_path) as folder:
            (folder / "a").write_text("half")
            raise KeyboardInterrupt

    (tmp_path / "a").write_text("old")
    with pytest.raises(KeyboardInterrupt):
        fail()
    assert (tmp_path / "a").read_text() == "old"
    with atomic_io.new_files(tmp_path) as folder:
        (folder / "a").write_text("new")
        (folder / "b").write_text("new")
    assert sorted(os.listdir(tmp_path)) == ["a", "b"]
    assert (tmp_path / "a").read_text() == "new"


@pytest.mark.parametrize("where", [".", "runs", "a/b/c"])
def test_a_folder_that_can_be_written_is_left_as_it_was(tmp_path, where):
    atomic_io.check_folder(tmp_path / where)
    atomic_io.check_file(tmp_path / where / "file")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "where", ["file", "file/runs", "file/a/b", "dangling/runs", "n" * 300, "runs/" + "n" * 300]
)
def test_a_folder_that_cannot_be_made_is_refused_and_named(tmp_path, where):
    (tmp_path / "file").write_text("")
    (tmp_path / "dangling").symlink_to(tmp_path / "nowhere")
    for check, path in (
        (atomic_io.check_folder, tmp_path / where),
        (atomic_io.check_file, tmp_path / where / "file"),
    ):
        with pytest.raises(OSError, match="cannot write to") as refused:
            check(path)
        assert str(tmp_path / where) in str(refused.value)
    assert sorted(os.listdir(tmp_path)) == ["dangling", "file"]


def test_a_file_whose_name_has_no_room_or_is_a_folders_is_refused(tmp_path):
    (tmp_path / "folder").mkdir()
    for name in ("folder", "n" * 250):  # the temporary name beside it is longer
        with pytest.raises(OSError, match="cannot write to"):
            atomic_io.check_file(tmp_path / name)
    assert os.listdir(tmp_path) == ["folder"]


def test_a_folder_in_place_of_a_file_is_named_as_the_user_did(tmp_path):
    said = re.escape(f"cannot write to {tmp_path}: it is a folder")
    with pytest.raises(IsADirectoryError, match=said), atomic_io.new_file(tmp_path) as path:
        path.write_bytes(b"never")
    with pytest.raises(IsADirectoryError, match=said):
        atomic_io.write(tmp_path, b"never")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("error", [PermissionError(13, "Permission denied"), OSError(28, "No space left")])
@pytest.mark.parametrize("call", ["fsync", "mkdir"])
def test_no_permission_and_a_full_disk_are_found_out(tmp_path, monkeypatch, call, error):
    def refuse(*_, **__):
        raise error

    with monkeypatch.context() as patched:
        patched.setattr(os, call, refuse)
        with pytest.raises(type(error), match=f"cannot write to {tmp_path}.*: {error.strerror}"):
            atomic_io.check_folder(tmp_path / "runs")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_another_process_made_meanwhile_stays(tmp_path):
    def write():
        with atomic_io.new_folder(tmp_path / "run") as folder:
            (folder / "mine").touch()
            (tmp_path / "run").mkdir()
            (tmp_path / "run" / "theirs").touch()

    with pytest.raises(FileExistsError, match="run exists already"):
        write()
    assert {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*")} == {"run", "run/theirs"}
