"""A decorator like `numba.njit(cache=True)` whose cache depends on all sources of a package.

Numba stores a compiled function beside its source and compiles it again when that file changes, but not when
a function that it calls changes in another file. A kernel would silently keep the old code. Here the cache is
valid only while the contents of every source file of the package, and of `estimator`, are the same.
"""

import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from numba import njit

_ESTIMATOR = Path(__file__).parents[1]


def compiler(package: Path, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Returns a decorator that compiles on first use and keeps the result on disk.

    Args:
        package: Folder of the package that holds the functions.
        **options: Options of `numba.njit`.
    """
    stamp = _digest(package), _digest(_ESTIMATOR)

    def compiled(function: Callable[..., Any]) -> Any:
        dispatcher: Any = njit(cache=True, **options)(function)
        # numba has no public option for this; a cache file with another stamp is rebuilt
        dispatcher._cache._cache_file._source_stamp = stamp
        return dispatcher

    return compiled


@cache
def _digest(package: Path) -> str:
    """Hash of the names and contents of all sources of a package."""
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py")):
        source = path.read_bytes()
        digest.update(f"{path.relative_to(package).as_posix()} {len(source)}\n".encode())
        digest.update(source)
    return digest.hexdigest()
