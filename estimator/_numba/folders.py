"""Where compiled programs are kept: beside their source, or where the user or the system allows it."""

from __future__ import annotations

import hashlib
import os
import tempfile
import warnings
from functools import cache
from pathlib import Path

from numba.core import config
from numba.misc.appdirs import AppDirs


def program_folder(file: str) -> Path | None:
    """Folder for the compiled functions of a source file; None if they cannot be kept.

    It is the first that can be written: a folder in NUMBA_CACHE_DIR, if that is set; `__pycache__` beside the
    source; numba's folder in the user's cache; a folder of the user among the temporary files.

    Args:
        file: The source file.
    """
    path = Path(file).absolute()
    return _program_folder(path.parent, str(vars(config)["CACHE_DIR"])) if path.is_file() else None


@cache
def _program_folder(source: Path, chosen: str) -> Path | None:
    name = f"{source.name}_{hashlib.sha256(str(source).encode()).hexdigest()[:16]}"
    if chosen:
        folders = [Path(chosen) / name]
    else:
        home = Path(AppDirs(appname="numba", appauthor=False).user_cache_dir)  # type: ignore[no-untyped-call]
        folders = [source / "__pycache__", home / name]
    for folder in folders:
        if folder.is_absolute() and _is_writable(folder):  # without a home it is "~"
            return folder
    own = _own_temporary_folder()
    if own is not None and _is_writable(own / name):
        return own / name
    _warn()
    return None


@cache
def _warn() -> None:
    """Warn once in a process that nothing can be kept."""
    warnings.warn(
        "compiled functions cannot be kept: every process compiles them again. "
        "Set NUMBA_CACHE_DIR to a folder that can be written",
        stacklevel=2,
    )


def _is_writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


def _own_temporary_folder() -> Path | None:
    """A folder that nobody but the user can write: loading a program from it runs code."""
    try:
        temporary = Path(tempfile.gettempdir())
    except FileNotFoundError:  # none can be written
        return None
    if not hasattr(os, "getuid"):
        return temporary / "numba_programs"  # Windows: a folder of the user already
    user = os.getuid()
    folder = temporary / f"numba_programs_{user}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        state = folder.lstat()
    except OSError:
        return None
    return folder if folder.is_dir() and state.st_uid == user and not state.st_mode & 0o077 else None
