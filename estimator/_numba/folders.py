"""Finds the folders of compiled programs, and lets one process at a time compile what others can use.

Programs of the user are written beside their source, or where the user or the system allows it. A wheel may
carry programs that were compiled for `TARGET`: they are read only.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite
import numba
from llvmlite import binding
from numba.core import config
from numba.misc.appdirs import AppDirs

from estimator._numba.program_file import trusted_owners
from estimator.own_folder import own_temporary_folder

fcntl: Any
try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

SHIPPED = Path(__file__).resolve().parents[1] / "_programs"
"""Folder of the programs that a wheel carries; a clone has none."""
ABOUT = "about.json"
"""File in it that holds `versions`."""
TARGET = "x86-64-v3"
"""Processors that the programs of a wheel are for: those with AVX2, which are all since about 2015."""
_NEEDED = ("avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe")
PATIENCE = 300.0
"""Time after which a process stops waiting and does the work itself [s]."""
_PAUSE = 0.05


@cache
def runs_shipped() -> bool:
    """Whether this processor runs programs that were compiled for `TARGET`."""
    features = binding.get_host_cpu_features()
    return binding.get_process_triple().startswith("x86_64-") and all(features.get(f) for f in _NEEDED)


def versions() -> dict[str, str]:
    """Versions that a program is compiled for."""
    python = str(sys.implementation.cache_tag)
    return {"python": python, "numba": numba.__version__, "llvmlite": llvmlite.__version__}


def why_compiling() -> str:
    """Says why programs that came with the installation are not used; empty if none came with it."""
    try:
        stored = json.loads((SHIPPED / ABOUT).read_text())
    except (OSError, ValueError):
        return ""
    if not runs_shipped():
        return f" (the programs that come with slipgym need a processor with {', '.join(_NEEDED)})"
    others = [f"{name} {stored.get(name)}" for name, found in versions().items() if stored.get(name) != found]
    if others:
        return f" (the programs that come with slipgym are for {', '.join(others)})"
    return " (no program that comes with slipgym is of the same sources, arguments and options)"


@cache
def place(source: Path) -> Path:
    """Path of a source folder within a store, relative.

    For a package it is the path from the outermost package, whatever folder that is installed in; for any
    other folder its name and a hash of its path.
    """
    if not (source / "__init__.py").is_file():
        return Path(f"{source.name}_{hashlib.sha256(str(source).encode()).hexdigest()[:16]}")
    outer = source
    while (outer.parent / "__init__.py").is_file():
        outer = outer.parent
    return source.relative_to(outer.parent)


def program_folder(file: str) -> Path | None:
    """Folder for the compiled functions of a source file; None if they cannot be kept.

    It is the first that can be written: a folder in NUMBA_CACHE_DIR, if that is set; `__pycache__` beside the
    source; numba's folder in the user's cache; a folder of the user among the temporary files.
    """
    path = Path(file).absolute()
    return _program_folder(path.parent, str(vars(config)["CACHE_DIR"])) if path.is_file() else None


@cache
def _program_folder(source: Path, chosen: str) -> Path | None:
    name = place(source)
    if chosen:  # users may share it: who cannot write to another's folder has one of their own
        own = f"{name}-user{os.getuid()}" if hasattr(os, "getuid") else name
        folders = filter(_is_writable, (Path(chosen) / name, Path(chosen) / own))
    else:
        home = Path(AppDirs(appname="numba", appauthor=False).user_cache_dir)  # type: ignore[no-untyped-call]
        candidates = [source / "__pycache__", home / name]  # without a home it is "~"
        folders = (f for f in candidates if f.is_absolute() and _is_writable(f) and _is_trusted(f))
    for folder in folders:
        return folder
    temporary = own_temporary_folder("numba_programs")
    if temporary is not None and _is_writable(temporary / name):
        return temporary / name
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


def _is_trusted(folder: Path) -> bool:
    """Whether a folder belongs to the user, to root or to the owner of the installation."""
    return not hasattr(os, "getuid") or folder.stat().st_uid in trusted_owners()


def _is_writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


@contextmanager
def only_one(path: Path, patience: float = PATIENCE) -> Iterator[None]:
    """Wait until no other process is in a block with the same path.

    A process that ends, however it does, leaves its block. Where files cannot be locked nobody waits; after
    `patience` [s] the block is entered all the same. The file is made for the purpose, and removed.
    """
    handle = _acquired(path, time.monotonic() + patience) if fcntl is not None else None
    try:
        yield
    finally:
        if handle is not None:
            path.unlink(missing_ok=True)
            os.close(handle)


def _acquired(path: Path, until: float) -> int | None:
    """Descriptor of the locked file; None if it could not be locked in time."""
    while True:
        try:
            handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        except OSError:
            return None
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.path.samestat(os.fstat(handle), path.stat()):
                return handle
        except FileNotFoundError:  # removed by the process that held it
            pass
        except BlockingIOError:
            if time.monotonic() > until:
                os.close(handle)
                return None
            time.sleep(_PAUSE)
        except OSError:  # a file system without locks
            os.close(handle)
            return None
        with suppress(OSError):
            os.close(handle)
