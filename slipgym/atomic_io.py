"""Writes files and folders whole or not at all, and waits until the disk has them.

The content goes to a temporary name beside the target, is flushed to the disk, and is then renamed. After a
crash the target holds its old content or the complete new one.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

SUFFIX = ".partial"
"""Ends the temporary names; a process that was killed can leave such files behind."""
_BLOCK = 4096  # bytes that a full disk refuses


def write(path: Path, data: bytes) -> None:
    """Writes a file, in place of the one that may be there.

    Args:
        path: The file; its folder must exist.
        data: Its whole content.

    Raises:
        OSError: It cannot be written.
    """
    _refuse_folder(path)
    with new_files(path.parent) as folder:
        (folder / path.name).write_bytes(data)


@contextmanager
def new_file(path: Path) -> Iterator[Path]:
    """Gives a temporary path to write to, which replaces the target at the end of the `with` block.

    It has the target's name, and so its suffixes. An error in the block leaves nothing behind; neither does a
    block that writes nothing.

    Args:
        path: The file; its folder is made if it does not exist.

    Raises:
        OSError: It cannot be written.
    """
    _refuse_folder(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    with new_files(path.parent) as folder:
        yield folder / path.name


@contextmanager
def new_folder(path: Path) -> Iterator[Path]:
    """Gives a temporary folder to fill, which takes its place at the end of the `with` block.

    An error in the block leaves nothing behind.

    Args:
        path: Where the folder shall appear.

    Raises:
        FileExistsError: Something is there already.
        OSError: It cannot be written.
    """
    if path.exists():
        raise FileExistsError(f"{path} exists already")
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = _partial(path)
    partial.mkdir()
    try:
        yield partial
        for each in partial.rglob("*"):
            _sync(each)
        _sync(partial)
        try:
            partial.rename(path)
        except OSError as error:  # another process was faster
            raise (FileExistsError(f"{path} exists already") if path.exists() else error) from None
    except BaseException:
        shutil.rmtree(partial, ignore_errors=True)
        raise
    _sync(path.parent)


@contextmanager
def new_files(folder: Path) -> Iterator[Path]:
    """Gives a temporary folder whose files replace those of a folder at the end of the `with` block.

    Each file is whole at any time; an error in the block leaves all of them as they were.

    Args:
        folder: The folder, which must exist.

    Raises:
        OSError: It cannot be written to.
    """
    partial = _partial(folder / "files")
    partial.mkdir()
    try:
        yield partial
        for each in partial.iterdir():
            _sync(each)
        for each in sorted(partial.iterdir()):
            os.replace(each, folder / each.name)
        _sync(folder)
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def check_folder(path: Path) -> None:
    """Finds out, before any work, whether folders and files can be put into a folder; leaves nothing behind.

    Args:
        path: The folder; it and those above it need not exist yet.

    Raises:
        OSError: They cannot, or the disk is full; the message names the path.
    """
    _try(path, "file")


def check_file(path: Path) -> None:
    """Finds out, before any work, whether a file can be written; leaves nothing behind.

    Args:
        path: The file; its folder need not exist yet.

    Raises:
        OSError: It cannot, or the disk is full; the message names the path.
    """
    _refuse_folder(path)
    _try(path.parent, path.name)


def _refuse_folder(path: Path) -> None:
    if os.path.isdir(path):
        raise IsADirectoryError(f"cannot write to {path}: it is a folder, name a file in it")


def _try(folder: Path, name: str) -> None:
    """Makes a folder's missing parts and a file in it, beside where they shall be, and removes them."""
    folder = folder.expanduser().absolute()
    base = next(each for each in (folder, *folder.parents) if os.path.lexists(each))
    if not os.path.isdir(base):
        raise NotADirectoryError(f"cannot write to {folder}: {base} is not a folder")
    try:
        with tempfile.TemporaryDirectory(prefix=".", suffix=SUFFIX, dir=base) as probe:
            inner = Path(probe) / folder.relative_to(base)
            inner.mkdir(parents=True, exist_ok=True)
            _partial(inner / name).mkdir()
            write(inner / name, bytes(_BLOCK))
    except OSError as error:
        raise type(error)(f"cannot write to {folder}: {error.strerror or error}") from error


def _partial(path: Path) -> Path:
    """A name beside the target that nobody else uses."""
    return path.with_name(f".{path.name}.{uuid.uuid4().hex}{SUFFIX}")


def _sync(path: Path) -> None:
    """Waits until the disk has a file's content, or the names in a folder (Windows does that itself)."""
    is_folder = path.is_dir()
    if is_folder and os.name == "nt":
        return
    descriptor = os.open(path, os.O_RDONLY if is_folder else os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
