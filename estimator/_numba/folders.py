"""Finds the folders of compiled programs.

Programs of the user are written beside their source, or where the user or the system allows it. A wheel may
carry programs that were compiled for `TARGET`: they are read only.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import tempfile
import warnings
from functools import cache
from pathlib import Path

import llvmlite
import numba
from llvmlite import binding
from numba.core import config
from numba.misc.appdirs import AppDirs

from estimator._numba.program_file import trusted_owners
from estimator.own_folder import own_temporary_folder

SHIPPED = Path(__file__).resolve().parents[1] / "_programs"
"""Folder of the programs that a wheel carries; a clone has none."""
ABOUT = "about.json"
"""File in it that holds `versions`."""
TARGET = "x86-64-v3"
"""Processors that the programs of a wheel are for: those with AVX2, which are all since about 2015."""
_NEEDED = ("avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe")


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

    Args:
        file: The source file.
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
