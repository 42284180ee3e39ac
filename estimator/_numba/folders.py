"""Where compiled programs are kept: beside their source, or where the user or the system allows it."""

from __future__ import annotations

import hashlib
import tempfile
import warnings
from functools import cache
from pathlib import Path

from numba.core import config
from numba.misc.appdirs import AppDirs

from estimator.own_folder import own_temporary_folder


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
    own = own_temporary_folder("numba_programs")
    # loading a program runs code: nobody else may write there
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
