"""Imports PyBullet without its banner ("pybullet build time: ..."), or stands in for it where it is missing.

from slipgym.world.quiet_pybullet import p
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

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


MISSING = (
    "engine='bullet' needs PyBullet, which is not installed: pip install 'slipgym[bullet]' (compiled for "
    "about 20 minutes on Python 3.12 and newer, where it has no wheel), or choose engine='planar'"
)


class _Missing:
    """Raises what to do at the first use of PyBullet."""

    def __getattr__(self, name: str) -> NoReturn:
        raise ModuleNotFoundError(MISSING, name="pybullet")


try:
    with _silent():
        import pybullet as p
except ModuleNotFoundError as error:
    if error.name != "pybullet":
        raise
    p: Any = _Missing()

__all__ = ["p"]
