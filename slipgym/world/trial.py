"""Tries a call that may crash the process, in a copy of the process."""

from __future__ import annotations

import faulthandler
import os
import signal
import time
import warnings
from collections.abc import Callable

PATIENCE = 10.0
"""Time after which a call counts as endless [s]."""


def survives(call: Callable[[], object]) -> bool:
    """Whether a call returns: without a crash, an exception or an endless loop.

    A fork has the same memory at the same addresses, so that the call then does the same here. Where there is
    no fork (Windows) the answer is True.

    Args:
        call: Calls compiled code alone; it prints nothing, since the copy's output is discarded.
    """
    if not hasattr(os, "fork"):
        return True
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # the copy needs no thread
        child = os.fork()
    if child == 0:
        _try(call)
    return _status(child) == 0


def _try(call: Callable[[], object]) -> None:
    """In the copy: make the call and end, with status 0 if it returned."""
    status = 1
    try:
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        faulthandler.disable()
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for stream in (1, 2):
            os.dup2(nowhere, stream)
        call()
        status = 0
    finally:
        os._exit(status)


def _status(child: int) -> int:
    """Wait for a copy, and end it if it takes too long; its exit status."""
    end = time.monotonic() + PATIENCE
    try:
        while time.monotonic() < end:
            found, status = os.waitpid(child, os.WNOHANG)
            if found:
                child = 0
                return os.waitstatus_to_exitcode(status)
            time.sleep(0.001)
        return -1
    finally:
        if child:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
