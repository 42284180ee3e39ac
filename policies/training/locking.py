"""Keeps a second process out of the folder of a run."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

fcntl: Any
try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

LOCK = ".lock"
"""Name of the file that is locked; it stays in the folder."""


@contextmanager
def only_process(folder: Path) -> Iterator[None]:
    """Hold the folder of a run; a process that ends, however it does, gives it back.

    Where files cannot be locked (Windows, some network file systems) nothing is held.

    Raises:
        ValueError: Another process holds it.
        OSError: The folder cannot be written to.
    """
    handle = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        if fcntl is not None:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                said = f"{folder}: another process trains this run; wait for it, or end it"
                raise ValueError(said) from None
            except OSError:  # a file system without locks
                pass
        yield
    finally:
        os.close(handle)
