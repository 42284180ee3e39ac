"""Lets one process at a time do what the others can use afterwards."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

fcntl: Any
try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

PATIENCE = 300.0
"""Time after which a process stops waiting and does the work itself [s]."""
_PAUSE = 0.05


@contextmanager
def only_one(path: Path, patience: float = PATIENCE) -> Iterator[None]:
    """Wait until no other process is in a block with the same path.

    A process that ends, however it does, leaves its block. Where files cannot be locked nobody waits.

    Args:
        path: A file that is made for the purpose, and removed.
        patience: Time after which the block is entered all the same [s].
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
