"""Compiled kernels whose cache notices a change in any of them.

Numba stores a compiled function beside its source and compiles it again when that file
changes, but not when a function it calls changes in another file: an edited friction law
would silently go on as it was. So every kernel here carries the stamp of the whole package.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba import njit


def _package_stamp() -> tuple[int, int]:
    """Newest modification [ns] and total size [B] of the package's sources."""
    states = [path.stat() for path in Path(__file__).parent.rglob("*.py")]
    return max(state.st_mtime_ns for state in states), sum(state.st_size for state in states)


_STAMP = _package_stamp()


def compiled(function: Callable[..., Any]) -> Any:
    """Compile a function with numba on first use and keep the result on disk."""
    dispatcher: Any = njit(cache=True)(function)
    # numba offers no public way to widen the stamp; a cache file with another one is rebuilt
    dispatcher._cache._cache_file._source_stamp = _STAMP
    return dispatcher
