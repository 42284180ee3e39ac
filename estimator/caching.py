"""Compiled functions whose cache notices a change in any file of their package.

Numba stores a compiled function beside its source and compiles it again when that file
changes, but not when a function it calls changes in another file: an edited kernel would
silently go on as it was. So every compiled function carries the stamp of its whole package.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba import njit


def compiler(package: Path, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Decorator that compiles on first use and keeps the result on disk.

    Args:
        package: Folder of the package whose sources the result depends on.
        **options: Of numba.njit.
    """
    states = [path.stat() for path in package.rglob("*.py")]
    stamp = max(state.st_mtime_ns for state in states), sum(state.st_size for state in states)

    def compiled(function: Callable[..., Any]) -> Any:
        dispatcher: Any = njit(cache=True, **options)(function)
        # numba offers no public way to widen the stamp; a cache file with another one is rebuilt
        dispatcher._cache._cache_file._source_stamp = stamp
        return dispatcher

    return compiled
