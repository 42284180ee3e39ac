"""Imports PyBullet without its banner ("pybullet build time: ...").

from slipgym.world.quiet_pybullet import p
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

STREAMS = 1, 2
"""File descriptors of standard output and standard error; which one has the banner depends on the version."""


@contextmanager
def _silent() -> Iterator[None]:
    """Discard what compiled code writes to standard output and standard error."""
    kept = {stream: os.dup(stream) for stream in STREAMS if _is_open(stream)}
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream in kept:
            os.dup2(nowhere, stream)
        yield
    finally:
        for stream, copy in kept.items():
            os.dup2(copy, stream)
            os.close(copy)
        os.close(nowhere)


def _is_open(stream: int) -> bool:
    try:
        os.fstat(stream)
    except OSError:
        return False
    return True


with _silent():
    import pybullet as p

__all__ = ["p"]
